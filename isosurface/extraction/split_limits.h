#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "adamas/geometry.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// Returns the distance that a diamond of a phase and all its descendants extend from its point along each
/// axis, in units of its scale. The box of this size round a diamond contains such boxes of its children.
constexpr std::int32_t nested_reach(int phase) { return 5 - phase; }

/// The regions in which a mesh must stay coarse because pages are lost. Diamonds there are never split, and
/// neither are all their descendants, so that the mesh stays conforming.
class LostRegions {
 public:
  [[nodiscard]] bool empty() const { return pages_.empty(); }
  void add(const PageId& page) { pages_.push_back(page); }

  /// Returns whether the diamond of a phase and point, in samples, whose scale is 2^lod samples, is never
  /// split.
  [[nodiscard]] bool blocks(LatticePoint p, int lod, int phase) const {
    return std::any_of(pages_.begin(), pages_.end(),
                       [&](const PageId& page) { return blocks(page, p, lod, phase); });
  }

 private:
  [[nodiscard]] bool blocks(const PageId& page, LatticePoint p, int lod, int phase) const {
    if (lod > page.lod) return false;
    const std::int32_t reach = (nested_reach(0) << page.lod) - (nested_reach(phase) << lod);
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t begin = page.block[axis] * PageGrid::kSide << page.lod;
      const std::int32_t end = begin + ((PageGrid::kSide - 1) << page.lod);
      if (p[axis] < begin - reach || p[axis] > end + reach) return false;
    }
    return true;
  }

  std::vector<PageId> pages_;
};

/// The limits of a surface's mesh. If a diamond may not be split, none of its descendants may.
struct SplitLimits {
  std::optional<std::array<Vec3, 2>> region;  ///< in samples: only diamonds that extend into it may be split
  LostRegions lost;                           ///< diamonds in these regions may not be split

  [[nodiscard]] bool any() const { return region.has_value() || !lost.empty(); }

  /// Returns whether the diamond of a phase and point, in samples, whose scale is 2^lod samples, may be
  /// split.
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

}  // namespace adamas::isosurface
