#pragma once

// Members of ViewedPages for what is known of other steps; viewed_pages.cpp alone includes this.

#include <algorithm>

#include "isosurface/view/viewed_pages.h"

namespace adamas::isosurface {

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
  StoredPages<typename ViewedDiamonds<Sample>::Word>& pages = diamonds_.pages();
  if (before_ == nullptr || page.step != before_->step() || page.crossed == nullptr) return false;
  const PageGrid& grid = diamonds_.grid();
  // Gradients near the border may be of samples of finer LODs, where the data are not large; and those that
  // the store keeps are not looked at.
  constexpr std::int32_t kReach = 4;
  const LatticePoint last = grid.last();
  if (page.lod > grid.top() || std::min({last.i, last.j, last.k}) < kReach << page.lod) return false;
  if (pages.file().header().gradients) return false;
  PageComparison comparison(*before_, pages);
  const PageId id{page.lod, page.block};
  if (loads_) pages.bounds(id);
  if (!comparison.has_same_samples(id) || !comparison.has_same_bounds(id)) return false;
  const LatticePoint blocks = grid.blocks(page.lod);
  for (std::int32_t n = 0; n < 27; ++n) {
    const LatticePoint block = page.block + step_around(n);
    if (is_below(block, blocks) && !comparison.has_same_samples({page.lod, block})) return false;
  }
  return true;
}

}  // namespace adamas::isosurface
