#pragma once

#include <array>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// Corners of the part of a tetrahedron inside a box (some may come more than once); empty where there is
/// none.
std::vector<Vec3> clip_to_box(const std::array<Vec3, 4>& tetrahedron, const Box3& box);

}  // namespace adamas
