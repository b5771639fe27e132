#pragma once

#include <algorithm>
#include <limits>

#include "isosurface/storage/store_format.h"
#include "isosurface/volume/error_scale.h"
#include "isosurface/volume/page.h"

namespace adamas {

/// Of the page's own points.
template <class Word>
PageSummary summary(const PageShape& shape, const Page<Word>& page) {
  PageSummary result;
  result.low = std::numeric_limits<Word>::max();
  for_each_own_place(shape, [&](std::size_t place) {
    result.low = std::min<std::uint32_t>(result.low, page.low[place]);
    result.high = std::max<std::uint32_t>(result.high, page.high[place]);
    result.error = std::max(result.error, page.errors[place]);
  });
  if (shape.complete) result.error = ErrorScale::kCodes - 1;
  const std::size_t count = result.part_count();
  if (count == 0) return result;
  if (shape.complete) {
    std::fill_n(result.part_errors.begin(), count, result.error);
    return result;
  }
  for_each_own_place(shape, [&](std::size_t place) {
    const std::uint32_t low = page.low[place], high = page.high[place];
    const std::uint8_t error = page.errors[place];
    if (low >= high || error == 0) return;
    for (std::size_t n = result.part(low + 1); n <= result.part(high); ++n)
      result.part_errors[n] = std::max(result.part_errors[n], error);
  });
  const int least = result.error - PageSummary::kSpan;
  for (std::uint8_t& error : result.part_errors) {
    if (error > 0) error = static_cast<std::uint8_t>(std::max<int>(error, least));
  }
  return result;
}

}  // namespace adamas
