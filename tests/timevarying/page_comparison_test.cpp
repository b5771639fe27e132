#include "isosurface/storage/page_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/test_series.h"
#include "timevarying/step_pages.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::Motion;
using test::TestSeries;

/// Returns a series in which only a corner changes, and that only in some steps.
TestSeries<std::uint8_t> moving_corner(int count) {
  TestSeries<std::uint8_t> series({70, 33, 20}, Motion::kStill, count);
  for (std::size_t step = 0; step < series.steps.size(); ++step) {
    std::vector<std::uint8_t>& samples = series.steps[step].samples;
    for (std::size_t n = 0; n < 6; ++n)
      samples[n] = static_cast<std::uint8_t>(samples[n] + step / 3 * (n + 1));
  }
  return series;
}

/// Expects that pages are the same where the comparison says so, whatever is in memory. Returns the share of
/// equal pages that it recognises.
double told(const TestSeries<std::uint8_t>& series, SampleCoding coding, bool in_memory) {
  const test::Scratch folder;
  build_series(folder / "a.adm", "a.adm", series.source(), test::with_blocks(12, coding));
  StoreFile file(folder / "a.adm"), other(folder / "a.adm");
  StepPages<std::uint8_t> steps(file, std::size_t{1} << 28), truth(other, std::size_t{1} << 28);
  std::size_t same = 0, known = 0;
  for (std::uint32_t to = 1; to < file.steps(); ++to) {
    const std::uint32_t from = to - 1;
    if (to % kWholeSteps == 0 && !in_memory) continue;
    for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * file.grid().top()); ++number) {
      const PageId id = file.grid().page(number);
      if (!file.grid().contains(id)) continue;
      Page<std::uint8_t> a{}, b{};
      EXPECT_TRUE(truth.at(from).copy(id, a) && truth.at(to).copy(id, b));
      StoredPages<std::uint8_t>&before = steps.at(from), &after = steps.at(to);
      if (in_memory) {
        EXPECT_TRUE(before.bounds(id) != nullptr && after.bounds(id) != nullptr);
      }
      PageComparison comparison(before, after);
      const PageShape shape = page_shape(file.grid(), id);
      bool is_same = true, are_bounds_same = true;
      for (std::int32_t n = 0; n < shape.count.i * shape.count.j * shape.count.k; ++n) {
        const LatticePoint p{n % shape.count.i, n / shape.count.i % shape.count.j,
                             n / (shape.count.i * shape.count.j)};
        const std::size_t place = PageGrid::place(p, 0);
        is_same = is_same && a.samples[place] == b.samples[place];
        are_bounds_same = are_bounds_same && (!shape.owns(p) || (a.low[place] == b.low[place] &&
                                                                 a.high[place] == b.high[place] &&
                                                                 a.errors[place] == b.errors[place]));
      }
      const bool is_told = comparison.has_same_samples(id);
      EXPECT_TRUE(is_same || !is_told) << page_name(id) << " at step " << to;
      EXPECT_TRUE(are_bounds_same || !comparison.has_same_bounds(id)) << page_name(id) << " at step " << to;
      same += is_same ? 1 : 0;
      known += is_told ? 1 : 0;
    }
  }
  return static_cast<double>(known) / static_cast<double>(std::max<std::size_t>(1, same));
}

TEST(PageComparison, TellsNothingButWhatIsTheSame) {
  for (const SampleCoding coding : {SampleCoding::kInterpolation, SampleCoding::kSplitEdge}) {
    for (const bool in_memory : {false, true}) {
      EXPECT_GE(told(TestSeries<std::uint8_t>({70, 33, 20}, Motion::kStill, 14), coding, in_memory),
                in_memory ? 1 : 0.9);
      EXPECT_GT(told(moving_corner(14), coding, in_memory), in_memory ? 0.999 : 0.5);
      told(TestSeries<std::uint8_t>({36, 33, 20}, Motion::kWaves, 14), coding, in_memory);
    }
  }
}

}  // namespace
}  // namespace adamas
