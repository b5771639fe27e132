#pragma once

#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/volume.h"
#include "core/geometry/plane.h"

namespace adamas::inline core {

// These functions convert between the frame of a grid and space; VolumeGrid itself converts points.

/// Puts a surface from the grid's frame into space: its points, its normals as those of level sets turn, and
/// the order of corners so that triangles still face the same values.
void place_in_space(const VolumeGrid& grid, TriangleSurface& surface);

/// Converts a plane in space into one in the frame.
Plane plane_in_frame(const VolumeGrid& grid, const Plane& plane);

/// The part of a plane in space that lies within a grid's samples: a convex polygon in space, empty where the
/// plane misses them.
std::vector<Vec3> plane_in_samples(const VolumeGrid& grid, const Plane& plane);

/// The part of the frame that lies in a box in space: the points that lie in `box` and, where the axes run
/// aslant, behind all planes of `sides`, whose normals point away from it.
struct FrameRegion {
  Box3 box;
  std::vector<Plane> sides;
};
FrameRegion region_in_frame(const VolumeGrid& grid, const Box3& in_space);

/// Throws Error, which begins with `name`, where an axis has fewer than two samples: a section or a surface
/// needs space between samples.
void check_two_samples(const std::string& name, const VolumeGrid& grid);

}  // namespace adamas::inline core
