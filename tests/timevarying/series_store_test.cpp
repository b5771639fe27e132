#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "isosurface/storage/page_payload.h"
#include "isosurface/storage/restore.h"
#include "tests/support/prepared_volume.h"
#include "tests/support/test_series.h"
#include "timevarying/step_pages.h"
#include "timevarying/verify_store.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::Dimensions;
using test::MemoryVolume;
using test::Motion;
using test::TestSeries;
using test::with_blocks;

StoreOptions in_groups(std::uint32_t block_steps, std::uint32_t pages) {
  return with_blocks(block_steps, SampleCoding::kInterpolation, pages);
}

/// Expects the samples of all steps, read in an order that jumps, and the errors and ranges that each step
/// has on its own.
template <class Sample>
void expect_steps(const std::filesystem::path& path, const TestSeries<Sample>& series) {
  StoreFile file(path);
  ASSERT_EQ(file.steps(), series.steps.size());
  ASSERT_EQ(file.times(), series.source().times);
  const VerifiedStore verified = verify_store(file, 0, SilentProgress::instance());
  ASSERT_EQ(verified.pages, file.grid().page_count() * file.steps());
  ASSERT_EQ(verified.bad_pages + verified.bad_copies, 0u) << verified.problems.front().what;
  for (std::uint32_t n = 0; n < file.steps(); ++n) {
    const std::uint32_t step = (n * 7 + 3) % file.steps();
    SCOPED_TRACE(testing::Message() << "step " << step);
    const MemoryVolume<Sample>& volume = series.steps[step];
    ASSERT_EQ(test::restored_step_bits<Sample>(file, step), test::bits_of(volume.samples));
    const test::PreparedVolume<Sample> prepared(volume.grid.dimensions, volume.samples, volume.grid.spacing,
                                                NoiseBounds::kSame);
    SeriesPages<OrderedWord<Sample>> pages(file, step, 0);
    for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * file.grid().top()); ++number) {
      const PageId id = file.grid().page(number);
      if (!file.grid().contains(id)) continue;
      Page<OrderedWord<Sample>> found{};
      ASSERT_TRUE(pages.copy(id, found)) << page_name(id);
      const auto page = prepared.page(id);
      for_each_own_place(prepared.shape(id), [&](std::size_t at) {
        ASSERT_EQ(found.errors[at], page.errors[at]) << page_name(id) << " place " << at;
        ASSERT_LE(found.low[at], page.low[at]);
        ASSERT_GE(found.high[at], page.high[at]);
      });
    }
  }
}

template <class Sample>
class SeriesStoreOf : public testing::Test {};
using SampleTypes = testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(SeriesStoreOf, SampleTypes);

TYPED_TEST(SeriesStoreOf, GivesAllStepsBack) {
  const test::Scratch folder;
  for (const Motion motion : {Motion::kStill, Motion::kLinear, Motion::kWaves, Motion::kRandom}) {
    const TestSeries<TypeParam> series({18, 10, 9}, motion, 7);
    for (const std::uint32_t block : {1u, 4u, 32u}) {
      SCOPED_TRACE(testing::Message() << "motion " << static_cast<int>(motion) << ", blocks of " << block);
      build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(block));
      expect_steps(folder / "a.adm", series);
      if (this->HasFatalFailure()) return;
    }
    for (const SampleCoding coding : {SampleCoding::kSplitEdge, SampleCoding::kPlain}) {
      build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(5, coding));
      expect_steps(folder / "a.adm", series);
    }
  }
}

/// Steps come back whatever number of them is added at a time.
TYPED_TEST(SeriesStoreOf, GivesStepsBackThatWereAdded) {
  const test::Scratch folder;
  const TestSeries<TypeParam> series({12, 17, 20}, Motion::kWaves, 13);
  std::mt19937 random(5);
  for (const std::uint32_t group : {1u, 2u, 8u, 512u}) {
    std::size_t end = 1 + random() % 4;
    build_series(folder / "a.adm", "a.adm", series.source(0, end), in_groups(4, group));
    while (end < series.steps.size()) {
      const std::size_t begin = end;
      end = std::min(series.steps.size(), begin + 1 + random() % 5);
      append_series(StoreLock(folder / "a.adm"), series.source(begin, end), with_blocks(4));
    }
    expect_steps(folder / "a.adm", series);
    if (this->HasFatalFailure()) return;
  }
}

/// Plain steps may follow coded ones, and coded steps plain ones.
TYPED_TEST(SeriesStoreOf, GivesPlainStepsBackThatWereAdded) {
  const test::Scratch folder;
  const TestSeries<TypeParam> series({12, 17, 20}, Motion::kWaves, 10);
  const auto path = folder / "a.adm";
  build_series(path, "a.adm", series.source(0, 3), with_blocks(4));
  const StoreFigures plain =
      append_series(StoreLock(path), series.source(3, 6), with_blocks(4, SampleCoding::kPlain));
  EXPECT_GE(plain.bytes.samples, 3 * series.steps[0].grid.bytes());
  const StoreFigures coded = append_series(StoreLock(path), series.source(6, 10), with_blocks(4));
  EXPECT_LT(coded.bytes.samples, plain.bytes.samples);
  expect_steps(path, series);
}

TEST(SeriesStore, IsSmallerWhereStepsAreAlike) {
  const test::Scratch folder;
  const auto bytes = [&](const TestSeries<std::uint8_t>& series) {
    return build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(32)).file_bytes;
  };
  const Dimensions dimensions{33, 33, 33};
  const std::uint64_t one = bytes({dimensions, Motion::kWaves, 1});
  const std::uint64_t eight = bytes({dimensions, Motion::kWaves, 8});
  EXPECT_LT(eight, 8 * one - one / 4);
  // In seven of eight steps each page is stored as a copy of the one before.
  EXPECT_LT(bytes({dimensions, Motion::kStill, 8}), one + one / 3);
  // Samples that rise evenly have second differences of zero.
  EXPECT_LT(bytes({dimensions, Motion::kLinear, 8}), 4 * one);
}

TEST(SeriesStore, IsTheSameOnAnyNumberOfThreads) {
  const test::Scratch folder;
  const TestSeries<std::uint16_t> series({40, 33, 21}, Motion::kWaves, 10);
  for (const int threads : {1, 3}) {
    set_thread_limit(static_cast<std::size_t>(threads));
    const auto path = folder / std::to_string(threads);
    build_series(path, "a.adm", series.source(0, 6), with_blocks(4));
    append_series(StoreLock(path), series.source(6, 10), with_blocks(4));
  }
  set_thread_limit(0);
  EXPECT_EQ(test::bytes_of(folder / "1"), test::bytes_of(folder / "3"));
}

/// The parameter is the number of pages in a group.
class SeriesStoreInGroups : public testing::TestWithParam<std::uint32_t> {};
INSTANTIATE_TEST_SUITE_P(Groups, SeriesStoreInGroups, testing::Values(1u, 8u));

/// A process that adds steps may be stopped after any byte: earlier steps stay, and steps that are not
/// finished are not seen.
TEST_P(SeriesStoreInGroups, OpensWithAllFinishedStepsWhereverAddingEnds) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({9, 9, 18}, Motion::kWaves, 6);
  const auto path = folder / "a.adm", cut = folder / "cut.adm";
  build_series(path, "a.adm", series.source(0, 2), in_groups(8, GetParam()));
  for (std::size_t begin = 2; begin < 6; begin += 2) {
    const std::string before = test::bytes_of(path);
    append_series(StoreLock(path), series.source(begin, begin + 2), with_blocks(8));
    const std::string after = test::bytes_of(path);
    ASSERT_EQ(after.substr(StorePrologue::kBytes, before.size() - StorePrologue::kBytes),
              before.substr(StorePrologue::kBytes));
    for (std::size_t size = before.size(); size <= after.size(); ++size) {
      test::put_bytes(cut, before.substr(0, StorePrologue::kBytes) +
                               after.substr(StorePrologue::kBytes, size - StorePrologue::kBytes));
      StoreFile file(cut);
      ASSERT_EQ(file.steps(), begin);
      ASSERT_EQ(file.unfinished_bytes(), size - before.size());
      file.check_directory();
    }
    // Afterwards the steps can be added again, with the same bytes.
    append_series(StoreLock(cut), series.source(begin, begin + 2), with_blocks(8));
    ASSERT_EQ(test::bytes_of(cut), after);
  }
  expect_steps(path, series);
}

TEST_P(SeriesStoreInGroups, AnswersToFlippedBitsAndTruncation) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({18, 9, 17}, Motion::kWaves, 5);
  const auto path = folder / "a.adm";
  build_series(path, "a.adm", series.source(0, 3), in_groups(8, GetParam()));
  append_series(StoreLock(path), series.source(3, 5), with_blocks(8));
  const std::string whole = test::bytes_of(path);
  for (std::size_t at = 0; at < whole.size(); at += 11 + at % 13) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 1 << at % 8);
    test::put_bytes(path, bytes);
    bool found = false;
    try {
      StoreFile file(path);
      const VerifiedStore verified = verify_store(file, 0, SilentProgress::instance());
      found = verified.bad_pages + verified.bad_copies > 0;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("a.adm"), std::string::npos) << e.what();
      found = true;
    }
    EXPECT_TRUE(found) << "byte " << at;
  }
  for (std::size_t size = 0; size < whole.size(); size += 31) {
    test::put_bytes(path, whole.substr(0, size));
    EXPECT_THROW(StoreFile{path}, Error) << size;
  }
}

TEST(SeriesStore, RefusesOtherStepsThanThoseAfterItsLast) {
  const test::Scratch folder;
  const auto path = folder / "a.adm";
  const TestSeries<std::uint8_t> series({9, 9, 9}, Motion::kWaves, 3);
  build_series(path, "a.adm", series.source(0, 2), with_blocks(8));
  const std::string before = test::bytes_of(path);
  EXPECT_THROW(append_series(StoreLock(path), series.source(1, 2), with_blocks(8)), Error);
  const TestSeries<std::uint8_t> other({9, 9, 8}, Motion::kWaves, 3);
  EXPECT_THROW(append_series(StoreLock(path), other.source(2, 3), with_blocks(8)), Error);
  EXPECT_EQ(test::bytes_of(path), before);
}

TEST(SeriesStore, IsLockedForOneAtATime) {
  const test::Scratch folder;
  const auto path = folder / "a.adm";
  const TestSeries<std::uint8_t> series({9, 9, 9}, Motion::kWaves, 3);
  EXPECT_THROW(StoreLock{path}, Error);
  build_series(path, "a.adm", series.source(0, 2), with_blocks(8));
  {
    const StoreLock lock(path);
    EXPECT_THROW(StoreLock{path}, Error);
    EXPECT_EQ(StoreFile(path).steps(), 2u);
  }
  append_series(StoreLock(path), series.source(2, 3), with_blocks(8));
  expect_steps(path, series);
}

/// Steps are restored whatever their number, with memory for few of them or for none.
TEST(SeriesStore, RestoresManyStepsInOneCall) {
  const test::Scratch folder;
  const auto path = folder / "a.adm";
  const TestSeries<std::uint8_t> series({19, 18, 9}, Motion::kWaves, 70);
  build_series(path, "a.adm", series.source(), with_blocks(16));
  StoreFile file(path);
  const RestoredPart part = restored_part(file.header().grid, 0, {}, "a.adm");
  for (const std::size_t memory : {std::size_t{1}, std::size_t{1} << 14, std::size_t{1} << 26}) {
    std::vector<std::vector<std::byte>> found(70);
    const auto sink = [&found](std::uint32_t step, std::span<const std::byte> plane) {
      found[step].insert(found[step].end(), plane.begin(), plane.end());
    };
    restore_steps(file, {3, 69}, part, memory, sink, SilentProgress::instance());
    for (std::size_t step = 0; step < 70; ++step) {
      const auto expected = std::as_bytes(std::span(series.steps[step].samples));
      ASSERT_TRUE(step < 3 ? found[step].empty() : std::ranges::equal(found[step], expected)) << step;
    }
    EXPECT_TRUE(damaged_steps(file, {0, 69}, part, memory, SilentProgress::instance()).empty());
  }
}

/// The damaged steps are those that cannot be restored alone.
TEST(SeriesStore, FindsTheStepsThatAreDamaged) {
  const test::Scratch folder;
  const auto path = folder / "a.adm";
  const TestSeries<std::uint8_t> series({18, 10, 9}, Motion::kWaves, 12);
  build_series(path, "a.adm", series.source(), with_blocks(8));
  const std::string whole = test::bytes_of(path);
  std::size_t partly = 0;
  for (std::size_t at = 40; at < whole.size() / 2; at += whole.size() / 60) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 4);
    test::put_bytes(path, bytes);
    StoreFile file(path);
    const RestoredPart part = restored_part(file.header().grid, 0, {}, "a.adm");
    std::vector<std::uint32_t> expected;
    for (std::uint32_t step = 0; step < 12; ++step) {
      try {
        restore_step(
            file, step, part, 0, [](auto) {}, SilentProgress::instance());
      } catch (const DamagedPage&) {
        expected.push_back(step);
      }
    }
    EXPECT_EQ(damaged_steps(file, {0, 11}, part, 1 << 24, SilentProgress::instance()), expected) << at;
    EXPECT_EQ(verify_store(file, 0, SilentProgress::instance()).bad_steps, expected) << at;
    partly += expected.empty() || expected.size() == 12 ? 0 : 1;
  }
  EXPECT_GT(partly, 5u);
}

}  // namespace
}  // namespace adamas
