#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"
#include "core/base/typed_id.h"
#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"
#include "core/lattice/lattice_map.h"
#include "interfaces/hierarchy/element_pool.h"

namespace adamas::interfaces {

/// One bisection of a tetrahedron.
struct Split {
  TetrahedronId parent;
  std::array<TetrahedronId, 2> children;
  VertexId vertex;  ///< the new vertex, shared by all bisections of the diamond
};

/// The linked vertices, tetrahedra and diamonds of a pointer-based hierarchy (D 2): a binary tree of
/// tetrahedra per root, whose leaves are a conforming mesh of the domain. This class is for
/// reading; Hierarchy adds payloads and changes it. Ids are reused after a merge. Diamonds are those that
/// have a tetrahedron in the tree.
class HierarchyTopology {
 public:
  [[nodiscard]] const Domain& domain() const { return domain_; }

  [[nodiscard]] LatticePoint lattice(VertexId v) const { return vertices_[v.value].point; }
  [[nodiscard]] Vec3 position(VertexId v) const { return domain_.position(lattice(v)); }

  /// Returns the roots, six for each root cube; cubes ascend by x, then y, then z.
  [[nodiscard]] const std::vector<TetrahedronId>& roots() const { return roots_; }
  /// Returns the corners of a tetrahedron, positively oriented; the split edge comes first.
  [[nodiscard]] std::array<VertexId, 4> vertices(TetrahedronId t) const { return node(t).vertices; }
  [[nodiscard]] std::array<LatticePoint, 4> corners(TetrahedronId t) const {
    const auto v = vertices(t);
    return {lattice(v[0]), lattice(v[1]), lattice(v[2]), lattice(v[3])};
  }
  [[nodiscard]] std::array<VertexId, 2> split_edge(TetrahedronId t) const {
    return {node(t).vertices[0], node(t).vertices[1]};
  }
  [[nodiscard]] bool is_leaf(TetrahedronId t) const { return node(t).children == kNoPair; }
  /// Returns the parent of a tetrahedron; invalid for a root.
  [[nodiscard]] TetrahedronId parent(TetrahedronId t) const { return pairs_[t.value / 2].parent; }
  /// Returns the children of a tetrahedron that is no leaf; the first one has the first end of the split
  /// edge.
  [[nodiscard]] std::array<TetrahedronId, 2> children(TetrahedronId t) const {
    ADAMAS_ASSERT(!is_leaf(t));
    return tetrahedra_of(node(t).children);
  }
  /// Returns the diamond that bisects the tetrahedron.
  [[nodiscard]] DiamondId diamond(TetrahedronId t) const { return node(t).diamond; }
  [[nodiscard]] int level(TetrahedronId t) const { return kRootBits - 1 - record(diamond(t)).bits; }
  [[nodiscard]] int phase(TetrahedronId t) const { return record(diamond(t)).type().phase; }
  /// Returns whether the lattice is deep enough to bisect the tetrahedron.
  [[nodiscard]] bool can_split(TetrahedronId t) const {
    return record(diamond(t)).bits >= kRootBits - domain_.depth();
  }

  [[nodiscard]] LatticePoint lattice(DiamondId d) const { return record(d).point; }
  [[nodiscard]] bool is_split(DiamondId d) const { return record(d).vertex.valid(); }
  /// Returns the vertex that splits the diamond; invalid if it is not split.
  [[nodiscard]] VertexId split_vertex(DiamondId d) const { return record(d).vertex; }
  /// Returns whether all tetrahedra of the diamond are in the tree, that is, whether all its parents are
  /// split.
  [[nodiscard]] bool is_complete(DiamondId d) const { return record(d).count == record(d).full_count; }
  /// Returns the tetrahedra of the diamond that are in the tree: leaves or, in a split diamond, bisected
  /// ones.
  [[nodiscard]] SmallList<TetrahedronId, 8> tetrahedra(DiamondId d) const;
  /// Returns whether the diamond is split and none of its child diamonds is.
  [[nodiscard]] bool can_merge(DiamondId d) const;

  /// Returns the diamond at a lattice point; invalid if it has no tetrahedron in the tree.
  [[nodiscard]] DiamondId find(LatticePoint p) const {
    const DiamondId* found = diamond_at_.find(p);
    return found != nullptr ? *found : DiamondId();
  }
  [[nodiscard]] bool is_split(LatticePoint p) const {
    const DiamondId d = find(p);
    return d.valid() && is_split(d);
  }

  [[nodiscard]] std::size_t leaf_count() const { return leaf_count_; }
  /// Returns the number of all tetrahedra of the tree.
  [[nodiscard]] std::size_t tetrahedron_count() const { return 2 * pairs_.size(); }
  [[nodiscard]] std::size_t vertex_count() const { return vertices_.size(); }
  [[nodiscard]] std::size_t diamond_count() const { return diamonds_.size(); }
  /// Returns a number above all vertex ids, for arrays indexed by VertexId.
  [[nodiscard]] std::size_t vertex_slots() const { return vertices_.slots(); }
  /// Returns a number above all tetrahedron ids.
  [[nodiscard]] std::size_t tetrahedron_slots() const { return std::size_t{2} * pairs_.slots(); }
  /// Returns the memory in bytes, without payloads.
  [[nodiscard]] std::size_t bytes() const;

  /// Calls fn(TetrahedronId) for the leaves, depth first from the roots. The order depends only on the mesh,
  /// not on its history. The hierarchy must not change meanwhile.
  template <class Fn>
  void for_each_leaf(Fn&& fn) const;
  /// Calls fn(VertexId) for all vertices, by id.
  template <class Fn>
  void for_each_vertex(Fn&& fn) const {
    vertices_.for_each([&fn](std::uint32_t i) { fn(VertexId(i)); });
  }
  /// Calls fn(DiamondId) for all diamonds, by id.
  template <class Fn>
  void for_each_diamond(Fn&& fn) const {
    diamonds_.for_each([&fn](std::uint32_t i) { fn(DiamondId(i)); });
  }

 protected:
  explicit HierarchyTopology(const Domain& domain);
  HierarchyTopology(HierarchyTopology&&) = default;
  HierarchyTopology& operator=(HierarchyTopology&&) = default;
  ~HierarchyTopology() = default;

  /// Splits the leaf's diamond, its missing ancestors first, and appends all bisections. Does nothing for a
  /// tetrahedron that is no leaf or for which can_split() is false.
  void split_leaf(TetrahedronId leaf, std::vector<Split>& done);
  /// Removes the children and the split vertex of a diamond for which can_merge() is true.
  void merge_diamond(DiamondId d);

 private:
  friend struct HierarchyTestAccess;
  static constexpr std::uint32_t kNoPair = 0xffffffffu;
  static constexpr LatticePoint kNowhere{-1, -1, -1};

  struct Vertex {
    LatticePoint point = kNowhere;
    [[nodiscard]] bool is_free() const { return point == kNowhere; }
  };
  struct Node {
    std::array<VertexId, 4> vertices;
    DiamondId diamond;
    std::uint32_t children = kNoPair;
  };
  /// A pair of siblings; pair i has the tetrahedra 2 i and 2 i + 1.
  struct Pair {
    std::array<Node, 2> nodes;
    TetrahedronId parent;
    std::array<std::uint8_t, 2> slots{};  ///< the places in the diamonds' lists
    [[nodiscard]] bool is_free() const { return !nodes[0].diamond.valid(); }
  };
  struct Record {
    LatticePoint point = kNowhere;
    VertexId vertex;
    std::array<TetrahedronId, 8> tetrahedra;
    std::uint8_t count = 0;
    std::uint8_t full_count = 0;
    std::uint8_t type_index = 0;
    std::uint8_t bits = 0;
    [[nodiscard]] bool is_free() const { return point == kNowhere; }
    [[nodiscard]] const DiamondType& type() const { return kDiamondTypes[type_index]; }
  };

  static std::array<TetrahedronId, 2> tetrahedra_of(std::uint32_t pair) {
    return {TetrahedronId(2 * pair), TetrahedronId(2 * pair + 1)};
  }
  Node& node(TetrahedronId t) { return pairs_[t.value / 2].nodes[t.value % 2]; }
  [[nodiscard]] const Node& node(TetrahedronId t) const { return pairs_[t.value / 2].nodes[t.value % 2]; }
  Record& record(DiamondId d) { return diamonds_[d.value]; }
  [[nodiscard]] const Record& record(DiamondId d) const { return diamonds_[d.value]; }

  VertexId make_vertex(LatticePoint p);
  void make_root_cube(LatticePoint cube);
  DiamondId find_or_make_diamond(LatticePoint p, std::size_t type_index, int bits);
  void attach(TetrahedronId t, DiamondId d, std::uint8_t slot);
  void detach(TetrahedronId t);
  void split_complete(DiamondId d, std::vector<Split>& done);
  /// Returns the points of the child diamonds and prefetches their records, which are scattered in memory.
  std::array<LatticePoint, 8> prefetch_children(const Record& diamond) const;
  void link_children(const Record& diamond, const std::array<LatticePoint, 8>& points,
                     const std::array<std::uint32_t, 8>& pairs);

  Domain domain_;
  ElementPool<Vertex> vertices_;
  ElementPool<Pair> pairs_;
  ElementPool<Record> diamonds_;
  LatticeMap<DiamondId> diamond_at_;
  std::vector<TetrahedronId> roots_;
  std::size_t leaf_count_ = 0;
};

/// Returns all diamonds, ancestors first: by level and phase, then by their points, so that the order does
/// not depend on the history of ids.
std::vector<DiamondId> diamonds_in_order(const HierarchyTopology& hierarchy);

template <class Fn>
void HierarchyTopology::for_each_leaf(Fn&& fn) const {
  for (const TetrahedronId root : roots_) {
    TetrahedronId t = root;
    for (;;) {
      while (!is_leaf(t)) t = children(t)[0];
      fn(t);
      while (t != root && t.value % 2 == 1) t = parent(t);
      if (t == root) break;
      t = TetrahedronId(t.value + 1);
    }
  }
}

/// The payload of vertices or tetrahedra that carry no data; it takes no memory.
struct NoPayload {};

/// The pointer-based and generalized hierarchy (D 2): tetrahedra that are split and merged by diamonds, with
/// a payload on every vertex and every tetrahedron of the tree. Payloads are default values at first, and
/// again after a merge has removed their element. References to payloads stay valid until then.
template <class VertexPayload = NoPayload, class TetrahedronPayload = NoPayload>
class Hierarchy : public HierarchyTopology {
 public:
  using Split = interfaces::Split;

  explicit Hierarchy(const Domain& domain) : HierarchyTopology(domain) { grow_payloads(); }

  VertexPayload& payload(VertexId v) { return vertex_payloads_[v.value]; }
  const VertexPayload& payload(VertexId v) const { return vertex_payloads_[v.value]; }
  TetrahedronPayload& payload(TetrahedronId t) { return tetrahedron_payloads_[t.value]; }
  const TetrahedronPayload& payload(TetrahedronId t) const { return tetrahedron_payloads_[t.value]; }

  /// Splits the leaf's diamond, after the ancestors that this requires, and appends every bisection to
  /// `done`, parents first. Does nothing for a tetrahedron that is no leaf or for which can_split() is false.
  void split(TetrahedronId leaf, std::vector<Split>& done) {
    split_leaf(leaf, done);
    grow_payloads();
  }

  /// Removes the children and the split vertex of a diamond for which can_merge() is true, with their
  /// payloads; appends the tetrahedra that become leaves again. Does nothing for other diamonds.
  void merge(DiamondId d, std::vector<TetrahedronId>& restored) {
    if (!can_merge(d)) return;
    vertex_payloads_[split_vertex(d).value] = VertexPayload{};
    for (const TetrahedronId t : tetrahedra(d)) {
      restored.push_back(t);
      for (const TetrahedronId child : children(t)) tetrahedron_payloads_[child.value] = TetrahedronPayload{};
    }
    merge_diamond(d);
  }

  /// Resets all payloads to default values.
  void reset_payloads() {
    vertex_payloads_ = {};
    tetrahedron_payloads_ = {};
    grow_payloads();
  }

  /// Returns the memory in bytes, with the payloads but without memory to which they point.
  [[nodiscard]] std::size_t bytes() const {
    return HierarchyTopology::bytes() + vertex_payloads_.bytes() + tetrahedron_payloads_.bytes();
  }

 private:
  void grow_payloads() {
    vertex_payloads_.grow(vertex_slots());
    tetrahedron_payloads_.grow(tetrahedron_slots());
  }

  ChunkedArray<VertexPayload> vertex_payloads_;
  ChunkedArray<TetrahedronPayload> tetrahedron_payloads_;
};

}  // namespace adamas::interfaces
