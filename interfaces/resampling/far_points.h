#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/distance/closest_point_tree.h"
#include "core/geometry/tetrahedron.h"

namespace adamas::interfaces {

/// The greatest number of sample points of a line.
inline constexpr double kMostSamples = 64;

/// Calls visit(p) for sample points of a line: its ends, and points between them with a distance of at most
/// half of `target`, unless they would be too many.
template <class Visit>
void for_each_sample(const Vec3& a, const Vec3& b, double target, Visit&& visit) {
  const double steps = std::clamp(std::ceil(2 * distance(a, b) / target), 1.0, kMostSamples);
  for (double s = 0; s <= steps; ++s) visit(a + (s / steps) * (b - a));
}

/// Returns whether a corner or the middle of a triangle's part in a cell is farther than `target` from a
/// surface.
bool has_far_point_in(const Tetrahedron& cell, const std::array<Vec3, 3>& triangle,
                      const ClosestPointTree& surface, double target);

}  // namespace adamas::interfaces
