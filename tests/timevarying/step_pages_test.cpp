#include "timevarying/step_pages.h"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "isosurface/storage/restore.h"
#include "tests/support/test_series.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::Motion;
using test::TestSeries;
using test::with_blocks;

template <class Sample>
class StepPagesOf : public testing::Test {};
using SampleTypes = testing::Types<std::uint8_t, std::int16_t, float>;
TYPED_TEST_SUITE(StepPagesOf, SampleTypes);

template <class Word>
void expect_same_page(StoredPages<Word>& found, StoredPages<Word>& alone, const PageId& id,
                      bool with_bounds) {
  const PageSamples<Word>* const samples = found.samples(id);
  ASSERT_NE(samples, nullptr);
  const PageShape shape = page_shape(alone.grid(), id);
  const PagePoints<Word> expected_samples = alone.samples(id)->samples;
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      for (std::int32_t i = 0; i < shape.count.i; ++i) {
        const std::size_t place = PageGrid::place({i, j, k}, 0);
        ASSERT_EQ(samples->samples[place], expected_samples[place]);
      }
    }
  }
  if (!with_bounds) return;
  const PageBounds<Word>* const bounds = found.bounds(id);
  ASSERT_NE(bounds, nullptr);
  const PageBounds<Word>* const expected = alone.bounds(id);
  for_each_own_place(shape, [&](std::size_t place) {
    EXPECT_EQ(bounds->low[place], expected->low[place]);
    EXPECT_EQ(bounds->high[place], expected->high[place]);
    EXPECT_EQ(bounds->errors[place], expected->errors[place]);
  });
}

/// Any page of any step is that of the step alone, whatever the memory and the order of requests, and the
/// memory stays within its limit.
TYPED_TEST(StepPagesOf, AreThoseOfEachStepAlone) {
  using Word = OrderedWord<TypeParam>;
  const test::Scratch folder;
  for (const Motion motion : {Motion::kStill, Motion::kWaves}) {
    const TestSeries<TypeParam> series({40, 33, 33}, motion, 37);
    build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(20));
    for (const std::size_t memory : {std::size_t{0}, std::size_t{1} << 21, std::size_t{1} << 28}) {
      StoreFile file(folder / "a.adm"), other(folder / "a.adm");
      StepPages<Word> steps(file, memory);
      std::mt19937 random(7);
      std::vector<std::unique_ptr<SeriesPages<Word>>> alone(file.steps());
      std::uint32_t step = 0;
      for (int n = 0; n < 400; ++n) {
        if (n % 10 == 0) step = random() % 4 == 0 ? random() % 37 : (step + random() % 3 + 36) % 37;
        const PageId id =
            file.grid().page(1 + random() % ((std::uint64_t{2} << (3 * file.grid().top())) - 1));
        if (!file.grid().contains(id)) continue;
        if (alone[step] == nullptr)
          alone[step] = std::make_unique<SeriesPages<Word>>(other, step, std::size_t{1} << 28);
        SCOPED_TRACE(testing::Message() << "step " << step << " " << page_name(id));
        StoredPages<Word>& pages = steps.at(step);
        ASSERT_EQ(pages.step(), step);
        expect_same_page<Word>(pages, *alone[step], id, random() % 2 == 0);
        const PageMemory<Word>& taken = *pages.memory();
        EXPECT_LE(taken.taken(), memory + taken.least * sizeof(Page<Word>));
        EXPECT_LE(taken.caches.size(), StepPages<Word>::kMostSteps);
        if (testing::Test::HasFailure()) return;
      }
    }
  }
}

/// Forward or backward, a step is decoded only once while the steps that it is coded with are in memory.
TEST(StepPages, DecodeEachPageOnceInEitherDirection) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({33, 33, 33}, Motion::kWaves, 32);
  build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(32));
  for (const bool backward : {false, true}) {
    StoreFile file(folder / "a.adm");
    StepPages<std::uint8_t> steps(file, std::size_t{1} << 28);
    for (std::uint32_t n = 0; n < 32; ++n) {
      StoredPages<std::uint8_t>& pages = steps.at(backward ? 31 - n : n);
      for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * file.grid().top()); ++number) {
        const PageId id = file.grid().page(number);
        if (!file.grid().contains(id)) continue;
        ASSERT_NE(pages.bounds(id), nullptr);
      }
    }
    EXPECT_EQ(steps.counts().pages + steps.counts().predictors, 32 * file.grid().page_count());
  }
}

/// With the least memory that is possible, a step decodes only a few times as many pages as it and the steps
/// that it is coded with have.
TEST(StepPages, DecodeAStepInLittleMemory) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({129, 65, 33}, Motion::kWaves, 8);
  build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(8));
  StoreFile file(folder / "a.adm");
  const PageReads counts = restore_step(
      file, 7, restored_part(file.header().grid, 0, {}, file.name()), 0, [](std::span<const std::byte>) {},
      SilentProgress::instance());
  EXPECT_LT(counts.pages + counts.predictors, 2 * 8 * file.grid().page_count());
  SeriesPages<std::uint8_t> pages(file, 7, 0);
  for (std::uint64_t number = 1; number < std::uint64_t{2} << (3 * file.grid().top()); ++number) {
    const PageId id = file.grid().page(number);
    if (!file.grid().contains(id)) continue;
    ASSERT_NE(pages.bounds(id), nullptr);
  }
  EXPECT_LT(pages.counts().pages + pages.counts().predictors, 3 * 8 * file.grid().page_count());
}

}  // namespace
}  // namespace adamas
