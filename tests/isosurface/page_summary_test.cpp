#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <random>

#include "isosurface/storage/store_format.h"

namespace adamas {

using namespace isosurface;

namespace {

/// Returns the greatest code of the diamonds that a contour crosses; words below `least_above` are below the
/// contour.
template <class Word>
int greatest_crossed(const PageShape& shape, const Page<Word>& page, std::uint64_t least_above) {
  int greatest = 0;
  for_each_own_place(shape, [&](std::size_t place) {
    if (page.low[place] < least_above && least_above <= page.high[place])
      greatest = std::max<int>(greatest, page.errors[place]);
  });
  return greatest;
}

template <class Word>
class PageSummaryOf : public testing::Test {};
using Words = testing::Types<std::uint8_t, std::uint16_t, std::uint32_t>;
TYPED_TEST_SUITE(PageSummaryOf, Words);

TYPED_TEST(PageSummaryOf, BoundsTheErrorsThatAContourMeets) {
  using Word = TypeParam;
  std::mt19937_64 random(5);
  const auto page = std::make_unique<Page<Word>>();
  for (int round = 0; round < 60; ++round) {
    const auto side = [&] { return static_cast<std::int32_t>(1 + random() % 16); };
    const PageShape shape{{side(), side(), side()}, false, 1};
    // Ranges extend over one word up to all words. In some pages few diamonds have a range, so that parts are
    // empty.
    const Word spread =
        static_cast<Word>(std::numeric_limits<Word>::max() >> (random() % (8 * sizeof(Word))));
    const auto base =
        static_cast<Word>(random() % (std::uint64_t{std::numeric_limits<Word>::max()} - spread + 1));
    const std::uint64_t sparse = 1 + random() % 300;
    for (std::size_t n = 0; n < PageGrid::kPoints; ++n) {
      const auto word = [&] { return static_cast<Word>(base + random() % (std::uint64_t{spread} + 1)); };
      const Word a = word(), b = random() % 2 == 0 ? a : word();
      page->low[n] = std::min(a, b), page->high[n] = std::max(a, b);
      page->errors[n] = static_cast<std::uint8_t>(random() % sparse == 0 ? random() % 64 : 0);
    }
    const PageSummary found = summary(shape, *page);
    bool any = false;
    std::array<int, PageSummary::kParts> exact{};
    const std::uint64_t step = std::max<std::uint64_t>(1, (std::uint64_t{found.high} - found.low) / 200);
    for (std::uint64_t word = std::uint64_t{found.low} + 1; word <= found.high; word += step) {
      const int greatest = greatest_crossed(shape, *page, word);
      any = any || greatest > 0;
      if (found.part_count() == 0) {
        ASSERT_EQ(greatest, 0);
        continue;
      }
      const std::size_t part = found.part(static_cast<std::uint32_t>(word));
      ASSERT_LT(part, found.part_count());
      ASSERT_LE(greatest, found.part_errors[part]);
      exact[part] = std::max(exact[part], greatest);
    }
    ASSERT_LE(found.part_count(), PageSummary::kParts);
    // Where every word was tried, the errors of parts are exact.
    for (std::size_t part = 0; step == 1 && part < found.part_count(); ++part) {
      const int least = exact[part] == 0 ? 0 : std::max(exact[part], found.error - PageSummary::kSpan);
      ASSERT_EQ(found.part_errors[part], least) << "part " << part;
    }
    if (any) {
      ASSERT_GT(found.part_count(), 0u);
    }
  }
}

TEST(PageSummary, OfTheCoarsestPageHasTheGreatestErrorEverywhere) {
  const auto page = std::make_unique<Page<std::uint8_t>>();
  page->low.fill(3), page->high.fill(40), page->errors.fill(0);
  const PageSummary found = summary({{5, 5, 5}, true, 0}, *page);
  EXPECT_EQ(found.error, 63);
  EXPECT_EQ(found.part_count(), 10u);  // each part has four words
  for (std::size_t n = 0; n < found.part_count(); ++n) EXPECT_EQ(found.part_errors[n], 63);
}

}  // namespace
}  // namespace adamas
