#pragma once

#include <mutex>

#include "core/base/typed_id.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/network/vertex_tree.h"

namespace adamas {

/// For distances to the nearest vertex: one tree per interface of its vertices, and for each of them a
/// triangle that has it as a corner.
struct InterfaceNetwork::VertexTrees {
  struct Corner {
    std::uint32_t triangle;
    TriangleFeature feature;
  };
  struct Tree {
    std::vector<Corner> corners;
    VertexTree tree{{}};
  };
  std::once_flag built;
  IdVector<InterfaceId, Tree> trees;
};

}  // namespace adamas
