#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "core/base/typed_id.h"
#include "interfaces/network/body_winding.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// What a network builds when it is needed for the first time.
struct InterfaceNetwork::OnDemand {
  /// A vertex as a corner of one of its triangles.
  struct Corner {
    std::uint32_t triangle;
    TriangleFeature feature;
  };
  /// For distances to the nearest vertex of an interface: each vertex is a triangle of the tree, which has it
  /// as all of its corners.
  struct Vertices {
    std::vector<Corner> corners;  ///< by triangle of the tree
    ClosestPointTree tree;
  };
  std::once_flag vertices_built;
  IdVector<InterfaceId, Vertices> vertices;

  /// Winding numbers, for networks with gaps.
  std::once_flag winding_built;
  std::optional<BodyWinding> winding;
};

}  // namespace adamas::interfaces
