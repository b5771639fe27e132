#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "adamas/geometry.h"
#include "core/base/error.h"

namespace adamas::inline core {

/// The least length of cells, and the greatest coordinate: within them products of four lengths neither
/// overflow nor underflow, their rounding errors included.
inline constexpr double kLeastLength = 1e-50;
inline constexpr double kGreatestCoordinate = 1e50;
/// The greatest ratio of the sides of a box: beyond it the square of the shorter
/// side is lost in that of the longer one, and so are distances.
inline constexpr double kGreatestAspect = 1e8;

/// Whether two coordinates along an axis, the lower one first, are within these limits.
inline bool within_length_limits(double low, double high) {
  return high - low >= kLeastLength && std::max(std::abs(low), std::abs(high)) <= kGreatestCoordinate;
}

/// Checks a box: throws Error with `name` if its sides or coordinates are not within these limits.
inline void check_lengths(const std::string& name, const Box3& box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis], high = box.max[axis];
    if (within_length_limits(low, high)) continue;
    fail("{}: expected coordinates below {} that are more than {} apart, found {} and {} along {}", name,
         kGreatestCoordinate, kLeastLength, low, high, "xyz"[axis]);
  }
}

}  // namespace adamas::inline core
