#include "isosurface/compression/bounds/range_rounding.h"

#include <cstddef>

#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

/// Returns the number of levels, 2^bits apart, that enough of the words have; words are in ascending order.
template <class Word>
std::size_t count_levels(const std::vector<Word>& words, int bits) {
  const std::size_t enough = words.size() / 1000 + 1;
  std::size_t levels = 0;
  for (std::size_t begin = 0, end = 0; begin < words.size(); begin = end) {
    while (end < words.size() && words[end] >> bits == words[begin] >> bits) ++end;
    if (end - begin >= enough) ++levels;
  }
  return levels;
}

}  // namespace

template <class Word>
RangeRounding<Word> find_rounding(std::vector<Word> low, std::vector<Word> high) {
  RangeRounding<Word> rounding;
  if (low.empty() || high.empty()) return rounding;
  constexpr std::size_t kLevels = 7;
  std::sort(low.begin(), low.end());
  std::sort(high.begin(), high.end());
  int bits = 0;
  while (bits < RangeRounding<Word>::kMostBits &&
         std::max(count_levels(low, bits + 1), count_levels(high, bits + 1)) >= kLevels)
    ++bits;
  if (bits == 0) return rounding;
  return {bits, {low.front(), static_cast<Word>(~high.back())}};
}

ADAMAS_INSTANTIATE_FUNCTION_FOR_WORDS(find_rounding);

}  // namespace adamas::isosurface
