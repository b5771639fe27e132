#include "tests/support/golden_series.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>

#include "isosurface/storage/page_payload.h"
#include "tests/support/short_vectors.h"
#include "tests/support/test_series.h"
#include "timevarying/time_codec.h"
#include "timevarying/verify_store.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::GoldenSeries;

/// Calls f(series, steps) for each golden series.
template <class F>
void for_each_series(F f) {
  for (const GoldenSeries& series : test::golden_series()) {
    SCOPED_TRACE(series.name);
    with_sample_type(series.type,
                     [&](auto sample) { f(series, test::GoldenSteps<decltype(sample)>(series)); });
    if (testing::Test::HasFatalFailure()) return;
  }
}

template <class Sample>
void expect_steps(const GoldenSeries& series, const test::GoldenSteps<Sample>& wanted) {
  StoreFile file(series.path());
  ASSERT_EQ(file.steps(), wanted.steps.size());
  ASSERT_EQ(file.times(), wanted.source(0, series.ends.back()).times);
  ASSERT_EQ(file.header().group_pages, series.options.group_pages);
  const VerifiedStore verified = verify_store(file, 0, SilentProgress::instance());
  ASSERT_EQ(verified.bad_pages + verified.bad_copies, 0u);
  for (std::uint32_t step = 0; step < file.steps(); ++step)
    ASSERT_EQ(test::restored_step_bits<Sample>(file, step), test::bits_of(wanted.steps[step].samples));
}

TEST(GoldenSeriesStores, HoldTheirSteps) {
  for_each_series([](const auto& series, const auto& steps) { expect_steps(series, steps); });
}

TEST(GoldenSeriesStores, AreReadAlikeWithShortVectors) {
  const test::ShortVectors scope;
  for_each_series([](const auto& series, const auto& steps) { expect_steps(series, steps); });
}

/// Makes the files anew where ADAMAS_WRITE_GOLDEN is set.
TEST(GoldenSeriesStores, AreBuiltAlike) {
  const bool is_new = std::getenv("ADAMAS_WRITE_GOLDEN") != nullptr;
  for_each_series([&](const auto& series, const auto& steps) {
    const test::Scratch folder;
    const auto path = is_new ? series.path() : folder / "a.adm";
    steps.build(series, path);
    ASSERT_TRUE(test::bytes_of(path) == test::bytes_of(series.path()));
  });
}

TEST(GoldenSeriesStores, AreBuiltAlikeWithShortVectors) {
  const test::ShortVectors scope;
  for_each_series([&](const auto& series, const auto& steps) {
    const test::Scratch folder;
    steps.build(series, folder / "a.adm");
    ASSERT_TRUE(test::bytes_of(folder / "a.adm") == test::bytes_of(series.path()));
  });
}

/// The golden series have pages of all codings: in space, as differences of order 1 and of order 2, as copies
/// of the page before, and with the bounds of the page before.
TEST(GoldenSeriesStores, HavePagesOfAllKinds) {
  std::array<std::size_t, 3> orders{};
  std::size_t as_before = 0, earlier_bounds = 0, blocks = 0;
  for (const GoldenSeries& series : test::golden_series()) {
    StoreFile file(series.path());
    blocks = std::max(blocks, file.blocks());
    const PageGrid& grid = file.grid();
    for (std::uint32_t step = 0; step < file.steps(); ++step) {
      for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * grid.top()); ++number) {
        if (!grid.contains(grid.page(number))) continue;
        const StoreFile::Payload payload = file.read(step, grid.page(number));
        PagePayload parts;
        ASSERT_TRUE(split_payload(payload.bytes, file.header(step).coding, parts));
        const bool is_before = parts.samples.size() == 1 && parts.samples[0] == kAsBefore;
        as_before += is_before ? 1 : 0;
        orders.at(static_cast<std::size_t>(time_order(parts.samples))) += is_before ? 0 : 1;
        earlier_bounds += parts.has_earlier_bounds() ? 1 : 0;
      }
    }
  }
  for (const std::size_t count : orders) EXPECT_GT(count, 9u);
  EXPECT_GT(as_before, 9u);
  EXPECT_GT(earlier_bounds, 9u);
  EXPECT_GE(blocks, 3u);
}

}  // namespace
}  // namespace adamas
