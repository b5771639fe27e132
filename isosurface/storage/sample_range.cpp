#include "isosurface/storage/sample_range.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "isosurface/volume/samples.h"

namespace adamas {

template <class Sample>
std::optional<std::array<double, 2>> sample_range(StoredPages<OrderedWord<Sample>>& pages) {
  using Word = OrderedWord<Sample>;
  const PageGrid& grid = pages.grid();
  const PageId coarsest{grid.top(), {0, 0, 0}};
  const auto value = [](auto word) {
    return static_cast<double>(from_ordered<Sample>(static_cast<Word>(word)));
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (grid.depth() > 0) {
    const std::optional<PageEntry> all = pages.entry(coarsest);
    if (!all) return {};
    // The words of an empty range are no numbers.
    if (all->low > all->high) return std::array{kInfinity, -kInfinity};
    return std::array{value(all->low), value(all->high)};
  }
  // No diamond has a range where all samples are corners of the domain.
  const PageSamples<Word>* page = pages.samples(coarsest);
  if (page == nullptr) return {};
  std::array<double, 2> range{kInfinity, -kInfinity};
  const LatticePoint last = grid.last();
  for (std::int32_t corner = 0; corner < 8; ++corner) {
    const LatticePoint p{corner & 1, corner >> 1 & 1, corner >> 2};
    if (p.i > last.i || p.j > last.j || p.k > last.k) continue;
    const double found = value(page->samples[PageGrid::place(p, 0)]);
    if (std::isfinite(found)) range = {std::min(range[0], found), std::max(range[1], found)};
  }
  return range;
}

template std::optional<std::array<double, 2>> sample_range<std::uint8_t>(StoredPages<std::uint8_t>&);
template std::optional<std::array<double, 2>> sample_range<std::uint16_t>(StoredPages<std::uint16_t>&);
template std::optional<std::array<double, 2>> sample_range<std::int16_t>(StoredPages<std::uint16_t>&);
template std::optional<std::array<double, 2>> sample_range<float>(StoredPages<std::uint32_t>&);

}  // namespace adamas
