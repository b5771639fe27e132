#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>

#include "core/geometry/vec3.h"

namespace adamas {

/// How often something was mended, and where the first time.
struct Mended {
  std::size_t count = 0;
  Vec3 place;
  void add(const Vec3& at) {
    if (count++ == 0) place = at;
  }
};

/// A place for messages.
inline std::string place_text(const Vec3& p) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

}  // namespace adamas
