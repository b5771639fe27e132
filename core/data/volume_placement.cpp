#include "core/data/volume_placement.h"

#include <utility>

#include "core/base/error.h"

namespace adamas::inline core {

namespace {

/// Maps a normal of a surface from the frame to space: by the inverse transpose of the directions, times
/// their determinant.
Vec3 across_in_space(const VolumeGrid& grid, const Vec3& v) {
  const auto& [a, b, c] = grid.directions;
  const Vec3 result = v.x * cross(b, c) + v.y * cross(c, a) + v.z * cross(a, b);
  return grid.is_left_handed() ? -result : result;
}

}  // namespace

void place_in_space(const VolumeGrid& grid, TriangleSurface& surface) {
  if (grid.is_straight()) return;
  for (Vec3& p : surface.points) p = grid.in_space(p);
  for (Vec3& n : surface.normals) n = normalized(across_in_space(grid, n));
  if (!grid.is_left_handed()) return;
  for (auto& corners : surface.triangles) std::swap(corners[1], corners[2]);
}

Plane plane_in_frame(const VolumeGrid& grid, const Plane& plane) {
  if (grid.is_straight()) return plane;
  const auto& [a, b, c] = grid.directions;
  return {grid.in_frame(plane.origin), {dot(a, plane.normal), dot(b, plane.normal), dot(c, plane.normal)}};
}

std::vector<Vec3> plane_in_samples(const VolumeGrid& grid, const Plane& plane) {
  std::vector<Vec3> corners = clip_plane(plane_in_frame(grid, plane), grid.frame_box());
  for (Vec3& corner : corners) corner = grid.in_space(corner);
  return corners;
}

FrameRegion region_in_frame(const VolumeGrid& grid, const Box3& in_space) {
  if (grid.is_straight()) return {in_space, {}};
  FrameRegion region;
  for (const Vec3& corner : in_space.corners()) region.box.extend(grid.in_frame(corner));
  if (grid.is_along_axes()) return region;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 normal;
    normal[axis] = 1;
    region.sides.push_back(plane_in_frame(grid, {in_space.max, normal}));
    region.sides.push_back(plane_in_frame(grid, {in_space.min, -normal}));
  }
  return region;
}

void check_two_samples(const std::string& name, const VolumeGrid& grid) {
  for (const std::uint64_t n : grid.dimensions) {
    if (n < 2) fail("{}: expected two samples or more along each axis, found {}", name, n);
  }
}

}  // namespace adamas::inline core
