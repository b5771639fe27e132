#pragma once

#include <algorithm>

#include "adamas/geometry.h"

namespace adamas::datasets {

/// The length of a box's shortest edge, with which scenes scale.
inline double shortest_side(const Box3& box) {
  const Vec3 size = box.size();
  return std::min({size.x, size.y, size.z});
}

}  // namespace adamas::datasets
