#pragma once

#include <cstdint>
#include <string>

#include "adamas/volume.h"
#include "core/base/error.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// Throws Error, which begins with `name`, where a volume has more samples along an axis than pages allow.
inline void check_volume_dimensions(const std::string& name, const VolumeGrid& grid) {
  constexpr std::uint64_t kMost = (std::uint64_t{1} << PageGrid::kMaxDepth) + 1;
  for (const std::uint64_t n : grid.dimensions) {
    if (n > kMost) fail("{}: expected at most {} samples along each axis, found {}", name, kMost, n);
  }
}

}  // namespace adamas::isosurface
