#include "isosurface/compression/interpolation/interpolation_page.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <random>
#include <vector>

namespace adamas {

using namespace isosurface;

namespace {

constexpr LatticePoint kCounts[] = {{16, 16, 16}, {1, 16, 16},  {16, 1, 16}, {16, 16, 1},
                                    {7, 5, 3},    {16, 16, 12}, {2, 2, 2}};

/// Returns samples from 0 to `greatest`: any of them, or only the two ends, which lead to the greatest sums.
template <class Word, std::size_t kCount>
std::array<Word, kCount> some_samples(std::uint64_t greatest, bool ends, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::array<Word, kCount> samples;
  for (Word& sample : samples)
    sample = static_cast<Word>(ends ? (random() >> 20) % 2 * greatest : (random() >> 20) % (greatest + 1));
  return samples;
}

/// What a page is coded as, set by set: contexts and residuals, as numbers that do not depend on the depth.
struct Coded {
  std::vector<int> contexts;
  std::vector<std::int64_t> residuals;
  bool operator==(const Coded&) const = default;
};

/// Codes a page in memory that was filled with `litter` before.
template <class Depth>
Coded coded(LatticePoint count, std::uint64_t greatest, bool ends, int litter) {
  using Word = typename Depth::Word;
  using Page = InterpolationPage<Depth>;
  const auto around = some_samples<Word, Surroundings<Word>::kPoints>(greatest, ends, 1);
  const auto samples = some_samples<Word, PageGrid::kPoints>(greatest, ends, 2);
  const auto memory = std::make_unique<std::array<std::byte, sizeof(Page) + alignof(Page)>>();
  std::memset(memory->data(), litter, memory->size());
  void* at = memory->data();
  std::size_t space = memory->size();
  auto* const page = new (std::align(alignof(Page), sizeof(Page), at, space)) Page(count, around);
  Coded result;
  for (int set = 0; set < Page::Cells::kSets; ++set) {
    std::array<std::uint8_t, Page::kMostInSet> contexts;
    std::array<Word, Page::kMostInSet> folded;
    page->predict(set);
    page->contexts(
        set, [](auto activity) { return ActivityContext<Depth>::context(activity); }, contexts.data());
    page->residuals(set, samples, folded.data());
    page->apply(set, folded.data());
    for (std::size_t n = 0; n < page->size(set); ++n) {
      result.contexts.push_back(contexts[n]);
      const Word residual = ResidualToken<Word>::unfold(folded[n]);
      result.residuals.push_back(static_cast<std::make_signed_t<Word>>(residual));
    }
  }
  return result;
}

TEST(InterpolationPage, DoesNotDependOnWhatLiesInMemory) {
  for (const LatticePoint& count : kCounts) {
    EXPECT_EQ(coded<Depth8>(count, 255, false, 0), coded<Depth8>(count, 255, false, 0x7f));
    EXPECT_EQ(coded<Depth12>(count, 4094, false, 0), coded<Depth12>(count, 4094, false, 0x80));
    EXPECT_EQ(coded<Depth16>(count, 65535, false, 0), coded<Depth16>(count, 65535, false, 0x7f));
    EXPECT_EQ(coded<Depth32>(count, 0xffffffff, false, 0), coded<Depth32>(count, 0xffffffff, false, 0x80));
  }
}

TEST(InterpolationPage, IsTheSameInNumbersOfAnyWidth) {
  using Wide = SampleDepth<std::uint16_t, std::int32_t, 16, Depth12::kGreatest, 0>;
  for (const LatticePoint& count : kCounts) {
    for (const bool ends : {false, true}) {
      const Coded wide = coded<Wide>(count, Depth12::kGreatest, ends, 0);
      EXPECT_EQ(coded<Depth12>(count, Depth12::kGreatest, ends, 0), wide);
      EXPECT_FALSE(wide.residuals.empty());
    }
  }
}

TEST(ActivityContext, GrowsTwiceAnOctave) {
  EXPECT_EQ(ActivityContext<Depth16>::context(0), 0);
  EXPECT_EQ(ActivityContext<Depth16>::context(1), 1);
  EXPECT_EQ(ActivityContext<Depth16>::context(2), 3);
  EXPECT_EQ(ActivityContext<Depth16>::context(3), 4);
  for (int activity = 2; activity < 1 << 19; ++activity) {
    const int context = ActivityContext<Depth16>::context(activity);
    ASSERT_EQ(ActivityContext<Depth16>::context(2 * activity), context + 2);
    ASSERT_GE(ActivityContext<Depth16>::context(activity + 1), context);
  }
  EXPECT_EQ(ActivityContext<Depth12>::context(static_cast<std::int16_t>(65535)),
            ActivityContext<Depth12>::kContexts - 1);
}

}  // namespace
}  // namespace adamas
