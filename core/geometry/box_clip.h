#pragma once

#include <array>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas::inline core {

/// Leaves of a convex polygon the part where sign * p[axis] <= sign * wall, with the points on the wall
/// exactly there. `scratch` is memory to work in.
void clip_at_wall(std::vector<Vec3>& polygon, int axis, double wall, double sign, std::vector<Vec3>& scratch);

/// Leaves of a convex polygon the part inside a box.
void clip_to_box(std::vector<Vec3>& polygon, const Box3& box, std::vector<Vec3>& scratch);

/// Corners of the part of a tetrahedron inside a box (some may come more than once); empty where there is
/// none.
std::vector<Vec3> clip_to_box(const std::array<Vec3, 4>& tetrahedron, const Box3& box);

}  // namespace adamas::inline core
