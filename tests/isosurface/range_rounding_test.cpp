#include "isosurface/compression/bounds/range_rounding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace adamas {

using namespace isosurface;

namespace {

template <class Word>
class RangeRoundingOf : public testing::Test {};
using Words = testing::Types<std::uint8_t, std::uint16_t, std::uint32_t>;
TYPED_TEST_SUITE(RangeRoundingOf, Words);

/// Ranges inside others stay inside them, and rounded ranges contain the exact ones. Ranges that are not
/// known stay as they are.
TYPED_TEST(RangeRoundingOf, IsOutwardsAndKeepsTheOrder) {
  using Word = TypeParam;
  constexpr Word kMost = std::numeric_limits<Word>::max();
  std::mt19937_64 random(4);
  for (int turn = 0; turn < 2000; ++turn) {
    std::array<Word, 4> ends;
    for (Word& end : ends) end = static_cast<Word>(random() >> (random() % 60));
    std::sort(ends.begin(), ends.end());
    if (ends[3] == kMost) continue;
    const int bits = static_cast<int>(random() % (RangeRounding<Word>::kMostBits + 1));
    const RangeRounding<Word> rounding{bits, {ends[0], static_cast<Word>(~ends[3])}};
    // These are the range of the whole volume, one within it, an empty one, and one of all words.
    std::array<Word, 4> low{ends[0], ends[1], kMost, 0}, high{ends[3], ends[2], 0, kMost};
    rounding.round(low, high);
    EXPECT_EQ(low[0], ends[0]);
    EXPECT_EQ(high[0], ends[3]);
    EXPECT_LE(low[0], low[1]);
    EXPECT_LE(high[1], high[0]);
    EXPECT_LE(low[1], ends[1]);
    EXPECT_GE(high[1], ends[2]);
    EXPECT_LT(ends[1] - low[1], std::int64_t{1} << bits);
    EXPECT_LT(high[1] - ends[2], std::int64_t{1} << bits);
    EXPECT_EQ(low[2], kMost);
    EXPECT_EQ(high[2], 0);
    EXPECT_EQ(low[3], 0);
    EXPECT_EQ(high[3], kMost);
    const std::array<Word, 4> once_low = low, once_high = high;
    rounding.round(low, high);
    EXPECT_EQ(low, once_low);
    EXPECT_EQ(high, once_high);
  }
}

TYPED_TEST(RangeRoundingOf, LeavesSomeLevels) {
  using Word = TypeParam;
  std::mt19937_64 random(5);
  for (const unsigned most : {250u, 200u, 100u}) {
    const unsigned step = sizeof(Word) == 1 ? 1 : sizeof(Word) == 2 ? 200 : 10000000;
    std::vector<Word> low, high;
    for (int n = 0; n < 20000; ++n) {
      low.push_back(static_cast<Word>(random() % most * step));
      high.push_back(static_cast<Word>(low.back() + 5 * step));
    }
    // A few outliers do not count.
    if (sizeof(Word) > 1) low.push_back(0), high.push_back(std::numeric_limits<Word>::max() - 1);
    const RangeRounding<Word> rounding = find_rounding(low, high);
    ASSERT_GT(rounding.bits, 0);
    const std::uint64_t levels = std::uint64_t{most} * step >> rounding.bits;
    EXPECT_GE(levels, 6u);
    EXPECT_LE(levels, 40u);
    EXPECT_EQ(rounding.least[0], *std::min_element(low.begin(), low.end()));
    EXPECT_EQ(static_cast<Word>(~rounding.least[1]), *std::max_element(high.begin(), high.end()));
  }
}

TEST(RangeRounding, LeavesFewWordsAlone) {
  const std::vector<std::uint16_t> low{0, 5, 9, 0, 5}, high{5, 9, 20, 20, 7};
  EXPECT_EQ(find_rounding(low, high), RangeRounding<std::uint16_t>{});
  EXPECT_EQ(find_rounding(std::vector<std::uint8_t>{}, {}), RangeRounding<std::uint8_t>{});
}

}  // namespace
}  // namespace adamas
