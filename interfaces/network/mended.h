#pragma once

#include <cstddef>

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

}  // namespace adamas
