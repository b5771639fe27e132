#pragma once

#include <cstdint>

#include "isosurface/extraction/page_mask.h"
#include "isosurface/extraction/surface_cut.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// The pages round twice a page's block on the next finer LOD: a bit for each step from -1 to 1 along each
/// axis, i running fastest, in the order of step_around().
using ChildPages = std::uint32_t;

/// Returns the pages along one axis with the children of a diamond of phase 2 at a coordinate: the page
/// before the diamond's page and the two in it, as three bits.
constexpr unsigned child_pages_along(std::int32_t x) {
  return (x == 0 ? 1u : 0u) | (x <= PageGrid::kSide / 2 ? 2u : 0u) | (x >= PageGrid::kSide / 2 ? 4u : 0u);
}

/// Returns the pages with children of diamonds of phase 2 in a row, given those along i.
constexpr ChildPages child_pages_of_row(unsigned along_i, std::int32_t j, std::int32_t k) {
  ChildPages pages = 0;
  for (unsigned n = 0; n < 9; ++n) {
    if ((child_pages_along(j) >> n % 3 & child_pages_along(k) >> n / 3 & 1) != 0) pages |= along_i << 3 * n;
  }
  return pages;
}

/// Returns the pages with children of a diamond of phase 2.
constexpr ChildPages child_pages(LatticePoint q) {
  return child_pages_of_row(child_pages_along(q.i), q.j, q.k);
}

/// Returns the pages with children of some diamonds.
inline ChildPages child_pages(const PageMask& split) {
  constexpr std::int32_t kSide = PageGrid::kSide;
  ChildPages pages = 0;
  for (std::int32_t k = 0; k < kSide; ++k) {
    for (std::int32_t j = 0; j < kSide; ++j) {
      const RowPhases phases(j, k);
      const unsigned bits = split.rows[static_cast<std::size_t>(j + kSide * k)] &
                            ((phases.odd == 2 ? kOddPoints : 0u) | (phases.even == 2 ? kEvenPoints : 0u));
      if (bits == 0) continue;
      const unsigned along_i =
          ((bits & 1) != 0 ? 1u : 0u) | ((bits & 0x1ff) != 0 ? 2u : 0u) | ((bits & 0xff00) != 0 ? 4u : 0u);
      pages |= child_pages_of_row(along_i, j, k);
    }
  }
  return pages;
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
