#include "isosurface/storage/still_pages.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "isosurface/storage/step_pages.h"
#include "tests/support/test_series.h"

namespace adamas {
namespace {

using test::Motion;
using test::TestSeries;

/// A series of which only a corner moves, and that now and then.
TestSeries<std::uint8_t> moving_corner(int count) {
  TestSeries<std::uint8_t> series({70, 33, 20}, Motion::kStill, count);
  for (std::size_t step = 0; step < series.steps.size(); ++step) {
    std::vector<std::uint8_t>& samples = series.steps[step].samples;
    for (std::size_t n = 0; n < 6; ++n)
      samples[n] = static_cast<std::uint8_t>(samples[n] + step / 3 * (n + 1));
  }
  return series;
}

/// Pages that are told to be the same are; returns how many are told so of those of which that can be known.
double told(const TestSeries<std::uint8_t>& series, SampleCoding coding) {
  const test::Scratch folder;
  build_series(folder / "a.adm", "a.adm", series.source(), test::with_blocks(12, coding));
  StoreFile file(folder / "a.adm");
  StepPages<std::uint8_t> steps(file, std::size_t{1} << 28);
  StillPages still(file);
  std::size_t same = 0, known = 0;
  for (std::uint32_t to = 1; to < file.steps(); ++to) {
    for (std::uint32_t from = to - std::min(to, 3u); from < to; ++from) {
      for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * file.grid().top()); ++number) {
        const PageId id = file.grid().page(number);
        if (!file.grid().contains(id)) continue;
        Page<std::uint8_t> a{}, b{};
        EXPECT_TRUE(steps.at(from).copy(id, a) && steps.at(to).copy(id, b));
        bool is_same = true;
        for_each_own_place(page_shape(file.grid(), id), [&](std::size_t place) {
          is_same = is_same && a.samples[place] == b.samples[place] && a.low[place] == b.low[place] &&
                    a.high[place] == b.high[place] && a.errors[place] == b.errors[place];
        });
        const bool is_told = still.is_still(id, from, to, true);
        EXPECT_EQ(is_told, still.is_still(id, to, from, false));
        EXPECT_TRUE(is_same || !is_told) << page_name(id) << " from step " << from << " to " << to;
        const auto ends = [&](std::uint32_t step) { return step % kWholeSteps == 0 || step % 12 == 0; };
        bool can_be_known = true;
        for (std::uint32_t step = from + 1; step <= to; ++step) can_be_known = can_be_known && !ends(step);
        same += is_same && can_be_known ? 1 : 0;
        known += is_told ? 1 : 0;
      }
    }
  }
  return static_cast<double>(known) / static_cast<double>(std::max<std::size_t>(1, same));
}

TEST(StillPages, AreTheSame) {
  for (const SampleCoding coding : {SampleCoding::kInterpolation, SampleCoding::kSplitEdge}) {
    EXPECT_EQ(told(TestSeries<std::uint8_t>({70, 33, 20}, Motion::kStill, 20), coding), 1);
    EXPECT_GT(told(moving_corner(20), coding), 0.3);
    told(TestSeries<std::uint8_t>({36, 33, 20}, Motion::kWaves, 20), coding);
  }
}

}  // namespace
}  // namespace adamas
