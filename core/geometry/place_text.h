#pragma once

#include <fmt/format.h>

#include <string>

#include "core/geometry/vec3.h"

namespace adamas::inline core {

/// "(x, y, z)", for a place or a direction in messages. No zero has a sign.
inline std::string place_text(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x + 0.0, p.y + 0.0, p.z + 0.0);
}
/// "[0, 1] x [0, 1] x [0, 2]", for a box in messages.
inline std::string box_text(const Box3& box) {
  return fmt::format("[{:.6g}, {:.6g}] x [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}]", box.min.x, box.max.x,
                     box.min.y, box.max.y, box.min.z, box.max.z);
}

}  // namespace adamas::inline core
