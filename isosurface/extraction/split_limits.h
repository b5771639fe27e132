#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "core/geometry/vec3.h"
#include "isosurface/extraction/lost_regions.h"

namespace adamas {

/// Which diamonds a surface may split at all. With a diamond all that come from it are kept from it too.
struct SplitLimits {
  std::optional<std::array<Vec3, 2>> region;  ///< in samples: only what reaches it
  LostRegions lost;                           ///< nothing of these

  [[nodiscard]] bool any() const { return region.has_value() || !lost.empty(); }

  /// For the diamond of this phase and point, in samples, whose scale is 2^lod.
  [[nodiscard]] bool allow(LatticePoint p, int lod, int phase) const {
    return reaches_region(p, lod, phase) && (lost.empty() || !lost.blocks(p, lod, phase));
  }
  [[nodiscard]] bool reaches_region(LatticePoint p, int lod, int phase) const {
    if (!region) return true;
    const double reach = std::ldexp(nested_reach(phase), lod);
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] + reach < (*region)[0][axis] || p[axis] - reach > (*region)[1][axis]) return false;
    }
    return true;
  }
};

}  // namespace adamas
