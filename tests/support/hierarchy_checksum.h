#pragma once

#include <cstdint>

#include "interfaces/hierarchy/hierarchy.h"
#include "tests/support/mesh_laws.h"

namespace adamas::test {

/// Returns a checksum of the mesh of leaves alone. It does not depend on the order of elements and the
/// history of ids.
inline std::uint64_t checksum(const interfaces::HierarchyTopology& hierarchy) {
  std::uint64_t sum = hierarchy.leaf_count();
  hierarchy.for_each_leaf([&](TetrahedronId t) { sum += tetrahedron_checksum(hierarchy.corners(t)); });
  return sum;
}

}  // namespace adamas::test
