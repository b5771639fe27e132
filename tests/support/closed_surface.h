#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "core/data/interface_mesh.h"

namespace adamas::test {

/// A triangle between two regions; its normal points to the front.
struct SidedTriangle {
  std::array<std::uint32_t, 3> points;
  std::uint32_t front, back;
};

/// Returns the triangles of a mesh with their materials as regions.
std::vector<SidedTriangle> sided_by_material(const InterfaceMesh& mesh);

/// What check_edges finds at the edges of a network of interfaces.
struct EdgeReport {
  std::size_t inner_edges = 0;  ///< edges that lie on no side of the box
  /// Inner edges that the boundary of some region leaves more often one way than the other.
  std::size_t open = 0;
  std::size_t lonely = 0;  ///< inner edges with one triangle
  /// Inner edges whose triangles are not two, nor as many as the regions that meet there, counting a region
  /// for each side from which it comes to the edge.
  std::size_t uneven = 0;
  std::size_t degenerate = 0;  ///< triangles with one region on both sides or a repeated point
  std::string first;           ///< the first open or lonely edge, for messages
};

/// Checks every edge by brute force. An edge within `tolerance` of a side of the box counts as on it.
EdgeReport check_edges(const std::vector<Vec3>& points, const std::vector<SidedTriangle>& triangles,
                       const Box3& box, double tolerance);

/// Returns the volumes of the regions that a closed network cuts out of a box, by the divergence theorem: the
/// flux of (x - min.x, 0, 0) through the triangles and the face x = max.x. Areas on that face are found by
/// the same theorem in two dimensions, lengths on the edge y = max.y by that in one. `corner` is the region
/// that holds box.max.
std::vector<double> enclosed_volumes(const std::vector<Vec3>& points,
                                     const std::vector<SidedTriangle>& triangles, std::size_t regions,
                                     const Box3& box, std::uint32_t corner, double tolerance);

}  // namespace adamas::test
