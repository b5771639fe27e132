#pragma once

#include <algorithm>

#include "core/geometry/vec3.h"

namespace adamas::datasets {

/// Length of a box's shortest edge: what scenes scale with.
inline double shortest_side(const Box3& box) {
  const Vec3 size = box.size();
  return std::min({size.x, size.y, size.z});
}

}  // namespace adamas::datasets
