#pragma once

#include <cstdint>

#include "core/lattice/lattice_point.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// The pages round twice a page's block on the next finer LOD: a bit for each step from -1 to 1 along each
/// axis, i running fastest, in the order of step_around().
using ChildPages = std::uint32_t;

/// The pages that have children of a diamond of phase 2.
constexpr ChildPages child_pages(LatticePoint q) {
  // Along an axis these are the page before the diamond's page, and one or both of the two in it; the bits of
  // pages next to each other are `step` apart.
  const auto along = [](std::int32_t x, int step) {
    constexpr std::int32_t kMiddle = PageGrid::kSide / 2;
    return (x == 0 ? 1u : 0u) | (x <= kMiddle ? 1u << step : 0u) | (x >= kMiddle ? 1u << 2 * step : 0u);
  };
  return along(q.i, 1) * along(q.j, 3) * along(q.k, 9);
}

/// Calls visit(block) for these pages of a parent's block.
template <class Visit>
void for_each_child_page(LatticePoint parent, ChildPages pages, Visit&& visit) {
  for (std::int32_t n = 0; n < 27; ++n) {
    if ((pages >> n & 1) != 0) visit(2 * parent + step_around(n));
  }
}

/// Returns whether an LOD has a page at a block. LODs from the coarsest page's own on have one page.
inline bool has_page(const PageGrid& grid, int lod, LatticePoint block) {
  return is_below(block, grid.blocks(lod)) && (lod >= grid.top() || grid.contains({lod, block}));
}

/// Calls visit(block) for the pages next to a page whose diamonds are all children of diamonds of that page:
/// the LOD's last points lie in their first plane.
template <class Visit>
void for_each_page_of_last_points(const PageGrid& grid, int lod, LatticePoint block, Visit&& visit) {
  const LatticePoint last = grid.extent(lod);
  for (int axis = 0; axis < 3; ++axis) {
    LatticePoint next = block;
    if (PageGrid::kSide * ++next[axis] == last[axis]) visit(next);
  }
}

}  // namespace adamas::isosurface
