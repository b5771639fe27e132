#pragma once

#include <string>
#include <vector>

#include "adamas/meshes.h"
#include "adamas/volume.h"
#include "core/geometry/plane.h"
#include "core/geometry/vec3.h"

namespace adamas::inline core {

// Conversions between the frame of a grid and space; VolumeGrid itself has those of points.

/// Puts a surface from the grid's frame into space: its points, its normals as those of level sets turn, and
/// the order of corners so that triangles still face the same values.
void place_in_space(const VolumeGrid& grid, TriangleSurface& surface);

/// A plane in space as one in the frame.
Plane plane_in_frame(const VolumeGrid& grid, const Plane& plane);

/// What of a plane in space lies within a grid's samples: a convex polygon in space; empty where there is
/// nothing.
std::vector<Vec3> plane_in_samples(const VolumeGrid& grid, const Plane& plane);

/// What of the frame is in a box in space: what lies in `box` and, where the axes run aslant, on that side of
/// all `sides` which their normals point away from.
struct FrameRegion {
  Box3 box;
  std::vector<Plane> sides;
};
FrameRegion region_in_frame(const VolumeGrid& grid, const Box3& in_space);

/// Throws Error, which begins with `name`, where an axis has fewer than two samples: nothing lies between
/// them, so that there is no place for a section or a surface.
void check_two_samples(const std::string& name, const VolumeGrid& grid);

}  // namespace adamas::inline core
