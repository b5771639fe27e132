#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/view/edge_ends.h"

namespace adamas::isosurface {

enum class SurfaceForm : std::uint8_t {
  kPoints,   ///< points with normals, interpolated along the edges of the mesh
  kEdgeEnds  ///< the ends of these edges, for interpolation in drawing (D 5.6)
};

/// A part of the surface of a frame: the triangles that come from splitting the diamonds of one page of one
/// LOD, or those of the mesh in which nothing is split. All chunks of a frame together are its surface.
/// Neighbouring chunks each have a copy of the points that they share, with the same place and the same
/// normal to the last bit.
struct SurfaceChunk {
  std::uint64_t id = 0;        ///< the same for all chunks of one page
  std::uint64_t revision = 0;  ///< greater each time the chunk is made anew
  std::vector<Vec3> points;    ///< in the frame of the grid
  std::vector<Vec3> normals;   ///< for each point a unit vector to values below the isovalue, or zero
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< normals point to values below the isovalue
  /// The ends of the edges that have a point, in place of points and normals. Their coordinates count steps
  /// of `step` from `corner`, which are in the frame of the grid.
  std::vector<EdgeEnds> ends;
  Vec3 corner, step;
  double least_parameter = 0;  ///< see EdgeEnds::parameter
};

/// The ids of the chunks that the last frame has added, changed and removed, in ascending order.
struct ChunkChanges {
  std::vector<std::uint64_t> added, changed, removed;
};

}  // namespace adamas::isosurface
