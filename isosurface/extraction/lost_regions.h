#pragma once

#include <algorithm>
#include <vector>

#include "isosurface/volume/page_grid.h"

namespace adamas {

/// How far the diamonds that come from splitting one, and from splitting those, reach from its point along
/// each axis, in units of its scale: by its phase. The box of a diamond so far around contains its
/// children's.
constexpr std::int32_t nested_reach(int phase) { return 5 - phase; }

/// Where a mesh must stay coarse because pages cannot be had: the diamonds that are never split. With a
/// diamond all that come from it are among them, so that what is left can be split in a conforming mesh.
class LostRegions {
 public:
  [[nodiscard]] bool empty() const { return regions_.empty(); }

  /// `subtree_depth`: that of the store. Tetrahedra that stand for finer ones need the samples of those.
  explicit LostRegions(int subtree_depth = 0) : lods_more_(subtree_depth > 0 ? subtree_depth + 1 : 0) {}

  void add(const PageId& page) { regions_.push_back(page); }

  /// For the diamond of this phase and point, whose scale is 2^lod samples.
  [[nodiscard]] bool blocks(LatticePoint p, int lod, int phase) const {
    return std::any_of(regions_.begin(), regions_.end(),
                       [&](const PageId& page) { return blocks(page, p, lod, phase); });
  }

 private:
  [[nodiscard]] bool blocks(const PageId& page, LatticePoint p, int lod, int phase) const {
    if (lod > page.lod + lods_more_) return false;
    const std::int32_t reach = (nested_reach(0) << (page.lod + lods_more_)) - (nested_reach(phase) << lod);
    for (int axis = 0; axis < 3; ++axis) {
      const std::int32_t begin = page.block[axis] * PageGrid::kSide << page.lod;
      const std::int32_t end = begin + ((PageGrid::kSide - 1) << page.lod);
      if (p[axis] < begin - reach || p[axis] > end + reach) return false;
    }
    return true;
  }

  int lods_more_;
  std::vector<PageId> regions_;
};

}  // namespace adamas
