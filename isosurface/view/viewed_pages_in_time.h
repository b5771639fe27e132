#pragma once

// Members of ViewedPages for what is known of other steps; viewed_pages.cpp alone includes this.

#include <algorithm>

#include "isosurface/view/viewed_pages.h"

namespace adamas {

template <class Sample>
void ViewedPages<Sample>::renew(ViewedPage& page) {
  const std::uint32_t step = diamonds_.pages().step();
  if (is_still(page)) {
    if (page.chunk_step == page.step) page.chunk_step = step;
    page.step = step;
    return;
  }
  if (page.crossed != nullptr) forget_crossed(page);
  page.is_told = false;
  page.step = step;
}

template <class Sample>
bool ViewedPages<Sample>::is_still(const ViewedPage& page) {
  const PageGrid& grid = diamonds_.grid();
  // Gradients near the border may be of samples of finer LODs, where the data are not large.
  constexpr std::int32_t kReach = 4;
  const LatticePoint last = grid.last();
  if (page.lod > grid.top() || std::min({last.i, last.j, last.k}) < kReach << page.lod) return false;
  const LatticePoint blocks = grid.blocks(page.lod);
  for (std::int32_t n = 0; n < 27; ++n) {
    const LatticePoint block = page.block + LatticePoint{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    if (std::min({block.i, block.j, block.k}) < 0 || block.i >= blocks.i || block.j >= blocks.j ||
        block.k >= blocks.k)
      continue;
    if (!still_.is_still({page.lod, block}, page.step, diamonds_.pages().step(), loads_)) return false;
  }
  return true;
}

}  // namespace adamas
