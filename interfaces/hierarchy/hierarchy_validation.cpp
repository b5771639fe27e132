#include <fmt/format.h>

#include <stdexcept>
#include <string>

#include "core/lattice/mesh_laws.h"
#include "interfaces/hierarchy/hierarchy_topology.h"

namespace adamas::interfaces {
namespace {

[[noreturn]] void broken(const std::string& law) { throw std::logic_error("hierarchy: " + law); }

std::string text(LatticePoint p) { return fmt::format("({}, {}, {})", p.i, p.j, p.k); }

}  // namespace

void HierarchyTopology::validate() const {
  validate_tree();
  std::size_t split = 0, attached = 0;
  for_each_diamond([&](DiamondId d) {
    validate_diamond(d);
    if (is_split(d)) ++split;
    attached += record(d).count;
  });
  if (attached != tetrahedron_count()) {
    broken(fmt::format("{} tetrahedra, but diamonds list {}", tetrahedron_count(), attached));
  }
  if (diamond_at_.size() != diamond_count()) {
    broken(fmt::format("{} diamonds, but {} entries in the table", diamond_count(), diamond_at_.size()));
  }
  const auto [a, b, c] = domain_.roots();
  const std::size_t corners =
      static_cast<std::size_t>(a + 1) * static_cast<std::size_t>(b + 1) * static_cast<std::size_t>(c + 1);
  if (vertex_count() != corners + split) {
    broken(fmt::format("expected {} vertices, one for each root corner and split diamond, found {}",
                       corners + split, vertex_count()));
  }
  for_each_vertex([&](VertexId v) {
    const LatticePoint p = lattice(v);
    if (domain_.is_root_corner(p)) return;
    const DiamondId d = find(p);
    if (!d.valid() || split_vertex(d) != v) broken("vertex " + text(p) + " splits no diamond");
  });
  validate_mesh();
}

void HierarchyTopology::validate_tree() const {
  const std::size_t root_pairs = roots_.size() / 2;
  std::size_t leaves = 0, inner = 0;
  pairs_.for_each([&](std::uint32_t pair) {
    const TetrahedronId up = pairs_[pair].parent;
    if (pair < root_pairs ? up.valid() : !up.valid())
      broken(fmt::format("tetrahedron {} has a wrong parent", 2 * pair));
    if (up.valid() && (up.value / 2 >= pairs_.slots() || node(up).children != pair)) {
      broken(fmt::format("tetrahedron {} is no child of its parent", 2 * pair));
    }
    for (const TetrahedronId t : tetrahedra_of(pair)) {
      is_leaf(t) ? ++leaves : ++inner;
      if (!is_leaf(t) && (node(t).children >= pairs_.slots() || pairs_[node(t).children].parent != t)) {
        broken(fmt::format("tetrahedron {} is not the parent of its children", t.value));
      }
      validate_tetrahedron(t);
    }
  });
  if (leaves != leaf_count_) broken(fmt::format("{} leaves, but {} counted", leaves, leaf_count_));
  if (2 * (inner + root_pairs) != leaves + inner) broken("the tetrahedra are no binary trees");
}

void HierarchyTopology::validate_tetrahedron(TetrahedronId t) const {
  const std::string name = fmt::format("tetrahedron {}", t.value);
  const DiamondId d = diamond(t);
  if (!d.valid() || d.value >= diamonds_.slots() || record(d).is_free()) broken(name + " has no diamond");
  const std::uint8_t slot = pairs_[t.value / 2].slots[t.value % 2];
  if (slot >= 8 || record(d).tetrahedra[slot] != t) broken(name + " is not listed by its diamond");
  const std::array<LatticePoint, 4> expected = Diamond(record(d).point).tetrahedron(slot);
  for (std::size_t v = 0; v < 4; ++v) {
    const VertexId id = node(t).vertices[v];
    if (!id.valid() || id.value >= vertices_.slots() || vertices_[id.value].is_free()) {
      broken(name + " has a vertex that is not there");
    }
    if (lattice(id) != expected[v]) {
      broken(fmt::format("{} has vertex {}, its diamond {}", name, text(lattice(id)), text(expected[v])));
    }
  }
  const auto [a, b, p, q] = node(t).vertices;
  if (signed_volume(position(a), position(b), position(p), position(q)) <= 0)
    broken(name + " is not positively oriented");
}

void HierarchyTopology::validate_diamond(DiamondId d) const {
  const Record& r = record(d);
  const std::string name = "diamond " + text(r.point);
  if (find(r.point) != d) broken(name + " is not found by its point");
  if (!domain_.contains(r.point) || domain_.is_root_corner(r.point)) broken(name + " is no diamond's point");
  const Diamond shape(r.point);
  if (shape.type_index() != r.type_index || shape.scale_bits() != r.bits) broken(name + " has a wrong type");
  if (shape.tetrahedron_count(domain_) != r.full_count)
    broken(name + " expects a wrong number of tetrahedra");
  std::size_t present = 0, leaves = 0;
  for (const TetrahedronId t : r.tetrahedra) {
    if (!t.valid()) continue;
    ++present;
    if (t.value >= tetrahedron_slots() || diamond(t) != d) broken(name + " lists another's tetrahedron");
    if (is_leaf(t)) ++leaves;
  }
  if (present == 0 || present != r.count) broken(name + " has a wrong number of tetrahedra");
  std::size_t split_parents = 0;
  const auto parents = shape.parents(domain_);
  for (const LatticePoint parent : parents) split_parents += is_split(parent) ? 1 : 0;
  if (is_complete(d) != (split_parents == parents.size()))
    broken(name + " is not as complete as its parents");
  if (!is_split(d)) {
    if (leaves != present) broken(name + " is not split, but a tetrahedron of it is");
    return;
  }
  if (!is_complete(d)) broken(name + " is split before its parents");
  if (leaves != 0) broken(name + " is split, but a tetrahedron of it is not");
  if (r.vertex.value >= vertices_.slots() || lattice(r.vertex) != r.point)
    broken(name + " has a wrong split vertex");
}

void HierarchyTopology::validate_mesh() const {
  MeshLaws laws(domain_, [this](LatticePoint p) { return is_split(p); });
  for_each_leaf([&](TetrahedronId t) { laws.add(Diamond(lattice(diamond(t))), corners(t)); });
  laws.check_volume();
}

std::uint64_t HierarchyTopology::checksum() const {
  std::uint64_t sum = leaf_count_;
  for_each_leaf([&](TetrahedronId t) { sum += tetrahedron_checksum(corners(t)); });
  return sum;
}

}  // namespace adamas::interfaces
