#pragma once

#include <array>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::inline core {

/// Clips a convex polygon to the part where sign * p[axis] <= sign * wall, with the points on the wall
/// exactly there. `scratch` is memory to work in.
void clip_at_wall(std::vector<Vec3>& polygon, int axis, double wall, double sign, std::vector<Vec3>& scratch);

/// Clips a convex polygon to the part inside a box.
void clip_to_box(std::vector<Vec3>& polygon, const Box3& box, std::vector<Vec3>& scratch);

/// The corners of the part of a tetrahedron inside a box, some of which may come more than once; empty where
/// no part is inside.
std::vector<Vec3> clip_to_box(const std::array<Vec3, 4>& tetrahedron, const Box3& box);

}  // namespace adamas::inline core
