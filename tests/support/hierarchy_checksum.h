#pragma once

#include <cstdint>

#include "interfaces/hierarchy/hierarchy.h"
#include "tests/support/mesh_laws.h"

namespace adamas::test {

/// A checksum of the mesh of leaves alone: the same whatever the order of elements and the history of ids.
inline std::uint64_t checksum(const interfaces::HierarchyTopology& hierarchy) {
  std::uint64_t sum = hierarchy.leaf_count();
  hierarchy.for_each_leaf([&](TetrahedronId t) { sum += tetrahedron_checksum(hierarchy.corners(t)); });
  return sum;
}

}  // namespace adamas::test
