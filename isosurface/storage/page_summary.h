#pragma once

#include <algorithm>
#include <limits>

#include "isosurface/preprocessing/error_scale.h"
#include "isosurface/storage/page.h"
#include "isosurface/storage/store_format.h"

namespace adamas {

/// Of the page's own points.
template <class Word>
PageSummary summary(const PageShape& shape, const Page<Word>& page) {
  PageSummary result;
  result.low = std::numeric_limits<Word>::max();
  LatticePoint q{};
  for (q.k = 0; q.k < shape.count.k; ++q.k) {
    for (q.j = 0; q.j < shape.count.j; ++q.j) {
      for (q.i = 0; q.i < shape.count.i; ++q.i) {
        if (!shape.owns(q)) continue;
        const std::size_t place = PageGrid::place(q, 0);
        result.low = std::min<std::uint32_t>(result.low, page.low[place]);
        result.high = std::max<std::uint32_t>(result.high, page.high[place]);
        result.error = std::max(result.error, page.errors[place]);
      }
    }
  }
  if (shape.complete) result.error = ErrorScale::kCodes - 1;
  return result;
}

}  // namespace adamas
