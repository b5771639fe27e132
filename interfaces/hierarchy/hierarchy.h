#pragma once

#include <cstddef>
#include <vector>

#include "interfaces/hierarchy/element_pool.h"
#include "interfaces/hierarchy/hierarchy_topology.h"

namespace adamas::interfaces {

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
