#include "tests/support/table_contour.h"

#include <array>
#include <bit>
#include <numeric>

#include "core/base/large_pages.h"

namespace adamas::test {

DiamondsInSpace::DiamondsInSpace(const IndexedHierarchy& hierarchy,
                                 const std::optional<LatticePoint>& last_sample)
    : shift_(kRootBits - 1 - hierarchy.levels()) {
  std::uint64_t last = 0;
  reserve_in_large_pages(diamonds_, hierarchy.diamond_count());
  hierarchy.for_each_diamond([&](const Diamond& diamond, std::uint8_t slots) {
    if (last_sample && is_beyond(diamond, *last_sample)) return;
    const LatticePoint p = diamond.point();
    diamonds_.push_back({ZOrder::interleave({p.i >> shift_, p.j >> shift_, p.k >> shift_}), slots});
    last = std::max(last, diamonds_.back().place);
  });
  // The diamonds are sorted by a radix sort that starts from the lowest digit.
  constexpr int kDigitBits = 11;
  std::vector<PlacedDiamond> sorted;
  reserve_in_large_pages(sorted, diamonds_.size());
  sorted.resize(diamonds_.size());
  for (int bit = 0; bit < static_cast<int>(std::bit_width(last)); bit += kDigitBits) {
    std::array<std::size_t, (1u << kDigitBits) + 1> begin{};
    const auto digit = [bit](const PlacedDiamond& d) { return d.place >> bit & ((1u << kDigitBits) - 1); };
    for (const PlacedDiamond& d : diamonds_) ++begin[digit(d) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    for (const PlacedDiamond& d : diamonds_) sorted[begin[digit(d)]++] = d;
    diamonds_.swap(sorted);
  }
}

}  // namespace adamas::test
