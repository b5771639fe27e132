#include "tests/interfaces/hierarchy_validation.h"

#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "tests/support/mesh_laws.h"

namespace adamas::interfaces {
namespace {

[[noreturn]] void broken(const std::string& law) { throw std::logic_error("hierarchy: " + law); }

std::string text(LatticePoint p) { return fmt::format("({}, {}, {})", p.i, p.j, p.k); }

}  // namespace

void HierarchyTestAccess::validate() const {
  validate_tree();
  std::size_t split = 0, attached = 0;
  h.for_each_diamond([&](DiamondId d) {
    validate_diamond(d);
    if (h.is_split(d)) ++split;
    attached += h.record(d).count;
  });
  if (attached != h.tetrahedron_count()) {
    broken(fmt::format("{} tetrahedra, but diamonds list {}", h.tetrahedron_count(), attached));
  }
  if (h.diamond_at_.size() != h.diamond_count()) {
    broken(fmt::format("{} diamonds, but {} entries in the table", h.diamond_count(), h.diamond_at_.size()));
  }
  const auto [a, b, c] = h.domain_.roots();
  const std::size_t corners =
      static_cast<std::size_t>(a + 1) * static_cast<std::size_t>(b + 1) * static_cast<std::size_t>(c + 1);
  if (h.vertex_count() != corners + split) {
    broken(fmt::format("expected {} vertices, one for each root corner and split diamond, found {}",
                       corners + split, h.vertex_count()));
  }
  h.for_each_vertex([&](VertexId v) {
    const LatticePoint p = h.lattice(v);
    if (test::is_root_corner(h.domain_, p)) return;
    const DiamondId d = h.find(p);
    if (!d.valid() || h.split_vertex(d) != v) broken("vertex " + text(p) + " splits no diamond");
  });
  validate_mesh();
}

void HierarchyTestAccess::validate_tree() const {
  const std::size_t root_pairs = h.roots_.size() / 2;
  std::size_t leaves = 0, inner = 0;
  h.pairs_.for_each([&](std::uint32_t pair) {
    const TetrahedronId up = h.pairs_[pair].parent;
    if (pair < root_pairs ? up.valid() : !up.valid())
      broken(fmt::format("tetrahedron {} has a wrong parent", 2 * pair));
    if (up.valid() && (up.value / 2 >= h.pairs_.slots() || h.node(up).children != pair)) {
      broken(fmt::format("tetrahedron {} is no child of its parent", 2 * pair));
    }
    for (const TetrahedronId t : h.tetrahedra_of(pair)) {
      h.is_leaf(t) ? ++leaves : ++inner;
      if (!h.is_leaf(t) &&
          (h.node(t).children >= h.pairs_.slots() || h.pairs_[h.node(t).children].parent != t)) {
        broken(fmt::format("tetrahedron {} is not the parent of its children", t.value));
      }
      validate_tetrahedron(t);
    }
  });
  if (leaves != h.leaf_count_) broken(fmt::format("{} leaves, but {} counted", leaves, h.leaf_count_));
  if (2 * (inner + root_pairs) != leaves + inner) broken("the tetrahedra are no binary trees");
}

void HierarchyTestAccess::validate_tetrahedron(TetrahedronId t) const {
  const std::string name = fmt::format("tetrahedron {}", t.value);
  const DiamondId d = h.diamond(t);
  if (!d.valid() || d.value >= h.diamonds_.slots() || h.record(d).is_free()) broken(name + " has no diamond");
  const std::uint8_t slot = h.pairs_[t.value / 2].slots[t.value % 2];
  if (slot >= 8 || h.record(d).tetrahedra[slot] != t) broken(name + " is not listed by its diamond");
  const std::array<LatticePoint, 4> expected = Diamond(h.record(d).point).tetrahedron(slot);
  for (std::size_t v = 0; v < 4; ++v) {
    const VertexId id = h.node(t).vertices[v];
    if (!id.valid() || id.value >= h.vertices_.slots() || h.vertices_[id.value].is_free()) {
      broken(name + " has a vertex that is not there");
    }
    if (h.lattice(id) != expected[v]) {
      broken(fmt::format("{} has vertex {}, its diamond {}", name, text(h.lattice(id)), text(expected[v])));
    }
  }
  const auto [a, b, p, q] = h.node(t).vertices;
  if (signed_volume(h.position(a), h.position(b), h.position(p), h.position(q)) <= 0)
    broken(name + " is not positively oriented");
}

void HierarchyTestAccess::validate_diamond(DiamondId d) const {
  const auto& r = h.record(d);
  const std::string name = "diamond " + text(r.point);
  if (h.find(r.point) != d) broken(name + " is not found by its point");
  if (!h.domain_.contains(r.point) || test::is_root_corner(h.domain_, r.point))
    broken(name + " is no diamond's point");
  const Diamond shape(r.point);
  if (shape.type_index() != r.type_index || shape.scale_bits() != r.bits) broken(name + " has a wrong type");
  if (shape.tetrahedron_count(h.domain_) != r.full_count)
    broken(name + " expects a wrong number of tetrahedra");
  std::size_t present = 0, leaves = 0;
  for (const TetrahedronId t : r.tetrahedra) {
    if (!t.valid()) continue;
    ++present;
    if (t.value >= h.tetrahedron_slots() || h.diamond(t) != d) broken(name + " lists another's tetrahedron");
    if (h.is_leaf(t)) ++leaves;
  }
  if (present == 0 || present != r.count) broken(name + " has a wrong number of tetrahedra");
  std::size_t split_parents = 0;
  const auto parents = shape.parents(h.domain_);
  for (const LatticePoint parent : parents) split_parents += h.is_split(parent) ? 1 : 0;
  if (h.is_complete(d) != (split_parents == parents.size()))
    broken(name + " is not as complete as its parents");
  if (!h.is_split(d)) {
    if (leaves != present) broken(name + " is not split, but a tetrahedron of it is");
    return;
  }
  if (!h.is_complete(d)) broken(name + " is split before its parents");
  if (leaves != 0) broken(name + " is split, but a tetrahedron of it is not");
  if (r.vertex.value >= h.vertices_.slots() || h.lattice(r.vertex) != r.point)
    broken(name + " has a wrong split vertex");
}

void HierarchyTestAccess::validate_mesh() const {
  test::MeshLaws laws(h.domain_, [this](LatticePoint p) { return h.is_split(p); });
  h.for_each_leaf([&](TetrahedronId t) { laws.add(Diamond(h.lattice(h.diamond(t))), h.corners(t)); });
  laws.check_volume();
}

}  // namespace adamas::interfaces
