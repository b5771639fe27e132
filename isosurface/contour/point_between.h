#pragma once

#include <algorithm>

#include "core/geometry/vec3.h"

namespace adamas {

/// The point at parameter t from a to b; never beyond them by rounding, and with the same coordinate as they
/// have where theirs is the same.
inline Vec3 point_between(const Vec3& a, const Vec3& b, double t) {
  Vec3 result;
  for (int axis = 0; axis < 3; ++axis) {
    const double p = a[axis], q = b[axis];
    result[axis] = std::clamp(p + t * (q - p), std::min(p, q), std::max(p, q));
  }
  return result;
}

}  // namespace adamas
