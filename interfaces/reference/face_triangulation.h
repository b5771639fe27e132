#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// The constrained Delaunay triangulation of one side of a box: of all `points`, which lie on it and have its
/// corners among them, with the segments between them as edges. By exact predicates. Triangles are
/// counter-clockwise as seen from outside of the box. Throws Error where two segments cross or a point lies
/// on one.
std::vector<std::array<std::uint32_t, 3>> triangulate_box_side(
    const std::vector<Vec3>& points, const std::vector<std::uint32_t>& on_side,
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& segments, int side);

}  // namespace adamas
