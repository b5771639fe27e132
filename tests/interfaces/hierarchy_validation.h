#pragma once

#include <utility>

#include "interfaces/hierarchy/hierarchy.h"

namespace adamas::interfaces {

/// Has access to the links of a hierarchy, to check them or to break them on purpose.
struct HierarchyTestAccess {
  const HierarchyTopology& h;

  void validate() const;
  void validate_tree() const;
  void validate_tetrahedron(TetrahedronId t) const;
  void validate_diamond(DiamondId d) const;
  void validate_mesh() const;

  static void swap_vertices(HierarchyTopology& h, TetrahedronId t) {
    std::swap(h.node(t).vertices[2], h.node(t).vertices[3]);
  }
  static void move_vertex(HierarchyTopology& h, VertexId v) { h.vertices_[v.value].point.i += 2; }
  static void forget_children(HierarchyTopology& h, TetrahedronId t) {
    h.node(t).children = HierarchyTopology::kNoPair;
  }
  static void forget_split(HierarchyTopology& h, DiamondId d) { h.record(d).vertex = VertexId(); }
  static void forget_diamond(HierarchyTopology& h, DiamondId d) { h.diamond_at_.erase(h.lattice(d)); }
  static void forget_parent(HierarchyTopology& h, TetrahedronId t) {
    h.pairs_[t.value / 2].parent = TetrahedronId();
  }
  static void drop_from_diamond(HierarchyTopology& h, TetrahedronId t) {
    h.record(h.diamond(t)).tetrahedra[h.pairs_[t.value / 2].slots[t.value % 2]] = TetrahedronId();
  }
  static void miscount(HierarchyTopology& h) { ++h.leaf_count_; }
};

}  // namespace adamas::interfaces

namespace adamas::test {

/// Throws std::logic_error that names the first broken law of the mesh (D 2): links, orientation, diamonds
/// complete where split, no hanging vertex, integer volumes that add up to the domain's.
inline void validate(const interfaces::HierarchyTopology& hierarchy) {
  interfaces::HierarchyTestAccess{hierarchy}.validate();
}

}  // namespace adamas::test
