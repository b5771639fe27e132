#include "timevarying/series_frames.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "core/base/error.h"
#include "isosurface/view/paged_frames.h"
#include "tests/isosurface/frame_checks.h"
#include "tests/support/test_series.h"
#include "timevarying/play_order.h"
#include "timevarying/read_ahead.h"
#include "timevarying/step_pages.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::CameraPath;
using test::Chunks;
using test::expect_same;
using test::Motion;
using test::TestSeries;
using test::with_blocks;

constexpr std::uint32_t kSteps = 19;

Chunks chunks_of(const SeriesFrames& frames) {
  Chunks chunks;
  frames.for_each_chunk([&](const SurfaceChunk& chunk) {
    EXPECT_TRUE(chunks.emplace(chunk.id, chunk).second) << "two chunks with one id";
  });
  return chunks;
}

class SeriesFramesWalk : public testing::TestWithParam<unsigned> {
 protected:
  void SetUp() override { build(Motion::kWaves, {}); }

  void build(Motion motion, StoreOptions options) {
    options.block_steps = 10;
    options.group_pages = GetParam() == 1 ? 1 : GetParam() == 2 ? 8 : 512;
    const TestSeries<std::uint8_t> series({36, 33, 20}, motion, kSteps);
    build_series(path_, "a.adm", series.source(), options);
    box_ = series.steps[0].grid.box();
  }
  FrameRequest request(CameraPath& path) {
    FrameRequest wanted;
    wanted.viewpoint = path.next();
    if (path.number(4) == 0) isovalue_ = 45.5 + path.number(3) * 15;
    wanted.isovalue = isovalue_;
    wanted.pixels = 0.5 * (1 + path.number(8));
    if (path.number(3) == 0) wanted.max_triangles = 40 + path.number(12000);
    return wanted;
  }
  /// Expects the chunks and the figures of frames that begin at the step.
  void expect_fresh(const SeriesFrames& frames, std::uint32_t step, FrameRequest wanted,
                    const FrameFigures& figures) const {
    StoreFile file(path_);
    SeriesPages<std::uint8_t> pages(file, step, std::size_t{1} << 26);
    PagedFrames<std::uint8_t> fresh(pages);
    wanted.resident_only = false;
    const FrameFigures expected = fresh.refine(wanted);
    expect_same(chunks_of(frames), test::chunks_of(fresh));
    EXPECT_EQ(figures.triangles, expected.triangles);
    EXPECT_EQ(figures.largest_error, expected.largest_error);
  }

  const test::Scratch folder_;
  const std::filesystem::path path_ = folder_ / "a.adm";
  Box3 box_;
  double isovalue_ = 60.5;
};

/// Frames are those of the step alone in any order of steps, with any reading ahead, any size of reads and
/// any layout of pages.
TEST_P(SeriesFramesWalk, FramesThatWaitAreThoseOfTheStepAlone) {
  for (const std::uint64_t bytes : {0u, 2000u, 100'000u}) {
    StoreFile file(path_);
    ReadAhead ahead;
    ahead.bytes = bytes;
    ahead.is_backward = GetParam() % 2 == 0;
    ahead.memory = bytes < 10'000 ? 4000 : 1 << 20;
    set_read_ahead(file, ahead);
    const auto shared = SharedPages::open(file, GetParam() == 1 ? 0 : 1 << 26);
    const std::unique_ptr<SeriesFrames> frames = SeriesFrames::open(*shared);
    CameraPath path(box_, GetParam());
    std::uint32_t step = 0;
    for (int n = 0; n < 14; ++n) {
      SCOPED_TRACE(testing::Message() << "frame " << n << " step " << step << " bytes " << bytes);
      step = path.number(4) == 0 ? path.number(kSteps) : (step + path.number(3) + kSteps - 1) % kSteps;
      const FrameRequest wanted = request(path);
      expect_fresh(*frames, step, wanted, frames->next(step, wanted));
      if (path.number(3) != 0) frames->expect({(step + 1) % kSteps, (step + 2) % kSteps});
      if (path.number(5) == 0) frames->expect({});
      if (HasFailure()) return;
    }
    EXPECT_EQ(frames->paging_problem(), "");
  }
}

/// Frames of resident pages converge to those that wait for pages, at each step. A step whose pages were read
/// ahead is complete at once where it needs no others.
TEST_P(SeriesFramesWalk, FramesOfResidentPagesComeToBeThose) {
  build(GetParam() % 2 == 0 ? Motion::kStill : Motion::kWaves, {});
  StoreFile file(path_);
  const auto shared = SharedPages::open(file, 1 << 26);
  const std::unique_ptr<SeriesFrames> frames = SeriesFrames::open(*shared);
  CameraPath path(box_, GetParam());
  FrameRequest wanted = request(path);
  wanted.resident_only = true;
  wanted.max_triangles.reset();
  std::uint32_t step = 3;
  for (int n = 0; n < 6; ++n, step = (step + 1) % kSteps) {
    SCOPED_TRACE(testing::Message() << "frame " << n << " step " << step);
    FrameFigures figures = frames->next(step, wanted);
    // Where the series is still, all steps need the same pages.
    if (n > 0 && GetParam() % 2 == 0) {
      EXPECT_EQ(figures.pages_missing, 0u);
    }
    for (int looks = 0; frames->is_paging() && looks < 10'000; ++looks) {
      frames->wait();
      figures = frames->next(step, wanted);
    }
    EXPECT_EQ(figures.pages_missing, 0u);
    expect_fresh(*frames, step, wanted, figures);
    const std::uint32_t next = (step + 1) % kSteps;
    frames->expect({next});
    while (!frames->is_ready(next) && frames->is_reading_ahead()) frames->wait();
    EXPECT_TRUE(frames->is_ready(next));
    EXPECT_EQ(frames->paging_problem(), "");
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SeriesFramesWalk, testing::Range(1u, 3u));

/// Damaged pages of one step are an error of that step alone.
TEST(SeriesFrames, GoOnAfterAStepThatIsDamaged) {
  const test::Scratch folder;
  const std::filesystem::path path = folder / "a.adm";
  const TestSeries<std::uint8_t> series({36, 33, 20}, Motion::kWaves, 16);
  build_series(path, "a.adm", series.source(), with_blocks(1));
  StoreFile file(path);
  const std::optional<PageEntry> entry = file.entry(9, {0, {1, 1, 0}});
  ASSERT_TRUE(entry && entry->size > 4);
  {
    std::fstream damaged(path, std::ios::in | std::ios::out | std::ios::binary);
    damaged.seekp(static_cast<std::streamoff>(entry->offset + 2));
    damaged.write("\x55\xaa", 2);
  }
  const auto shared = SharedPages::open(file, 1 << 26);
  const std::unique_ptr<SeriesFrames> frames = SeriesFrames::open(*shared);
  FrameRequest wanted;
  wanted.isovalue = 60.5;
  wanted.pixels = 0.01;
  wanted.viewpoint.target = series.steps[0].grid.box().center();
  wanted.viewpoint.eye = wanted.viewpoint.target + Vec3{40, 30, 50};
  for (std::uint32_t step = 0; step < 9; ++step) EXPECT_GT(frames->next(step, wanted).triangles, 100u);
  EXPECT_THROW(frames->next(9, wanted), Error);
  // Steps that are coded with the damaged one are lost too.
  EXPECT_GT(frames->next(8, wanted).triangles, 100u);
  EXPECT_GT(frames->next(0, wanted).triangles, 100u);
  frames->expect({9, 10});
  while (frames->is_reading_ahead()) frames->wait();
  EXPECT_NE(frames->paging_problem(), "");
}

TEST(SeriesFrames, ReadLessOftenWhereMoreIsReadAtATime) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({48, 40, 34}, Motion::kWaves, 16);
  build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(16));
  std::map<std::uint64_t, std::uint64_t> reads, bytes;
  for (const std::uint64_t at_a_time : {0u, 4'000u, 1'000'000u}) {
    StoreFile file(folder / "a.adm");
    ReadAhead ahead;
    ahead.bytes = at_a_time;
    ahead.memory = 1 << 24;
    set_read_ahead(file, ahead);
    const auto shared = SharedPages::open(file, 1 << 26);
    const std::unique_ptr<SeriesFrames> frames = SeriesFrames::open(*shared);
    FrameRequest wanted;
    wanted.isovalue = 60.5;
    wanted.viewpoint.target = series.steps[0].grid.box().center();
    wanted.viewpoint.eye = wanted.viewpoint.target + Vec3{70, 60, 80};
    for (const std::uint32_t step : steps_in_order(PlayOrder::kForward, 0, 15)) frames->next(step, wanted);
    reads[at_a_time] = shared->page_reads();
    bytes[at_a_time] = file.bytes_read();
  }
  EXPECT_LT(4 * reads[4'000], 3 * reads[0]);
  // Each read takes one page of all steps.
  EXPECT_LE(reads[1'000'000], StoreFile(folder / "a.adm").grid().page_count());
  for (const auto& [at_a_time, read] : bytes) EXPECT_LE(read, std::filesystem::file_size(folder / "a.adm"));
}

TEST(SeriesFrames, TellHowMuchOfStepsIsInMemory) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({70, 65, 50}, Motion::kStill, 12);
  build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(1));
  StoreFile file(folder / "a.adm");
  const auto shared = SharedPages::open(file, std::size_t{1} << 28);
  const std::unique_ptr<SeriesFrames> frames = SeriesFrames::open(*shared);
  FrameRequest fine, coarse;
  fine.isovalue = 60.5;
  fine.pixels = 0.1;
  fine.viewpoint.target = series.steps[0].grid.box().center();
  fine.viewpoint.eye = fine.viewpoint.target + Vec3{70, 60, 80};
  coarse = fine;
  coarse.pixels = 200;
  for (const std::uint32_t step : {2u, 9u, 3u}) frames->next(step, coarse);
  frames->next(7, fine);
  frames->expect({8});
  while (frames->is_reading_ahead()) frames->wait();
  // The counts are taken before is_ready(), which decodes steps.
  const PageReads before = shared->counts();
  const std::vector<LoadedStep> loaded = frames->loaded_steps();
  EXPECT_EQ(shared->counts().pages, before.pages);
  EXPECT_EQ(shared->counts().bytes, before.bytes) << "a look reads nothing";
  std::map<std::uint32_t, LoadedStep> by_step;
  for (const LoadedStep& each : loaded) EXPECT_TRUE(by_step.emplace(each.step, each).second);
  for (std::uint32_t step = 0; step < 12; ++step) {
    SCOPED_TRACE(step);
    const LoadedStep one = by_step.contains(step) ? by_step.at(step) : LoadedStep{step, 0, 1};
    EXPECT_EQ(one.pages == one.needed, frames->is_ready(step));
    EXPECT_EQ(one.pages == one.needed, step == 7 || step == 8);
    const bool is_coarse = step == 2 || step == 9 || step == 3;
    EXPECT_EQ(one.pages > 0 && one.pages < one.needed, is_coarse);
  }
}

TEST(PlayOrder, GoesThroughAllSteps) {
  using Steps = std::vector<std::uint32_t>;
  EXPECT_EQ(steps_in_order(PlayOrder::kForward, 2, 4), (Steps{2, 3, 4}));
  EXPECT_EQ(steps_in_order(PlayOrder::kBackward, 2, 4, 2), (Steps{4, 3, 2, 4, 3, 2}));
  EXPECT_EQ(steps_in_order(PlayOrder::kThereAndBack, 2, 4, 2), (Steps{2, 3, 4, 3, 2, 3, 4, 3}));
  EXPECT_EQ(steps_in_order(PlayOrder::kThereAndBack, 5, 5), (Steps{5}));
  const Steps random = steps_in_order(PlayOrder::kRandom, 10, 29, 3, 4);
  EXPECT_EQ(random.size(), 60u);
  EXPECT_EQ(random, steps_in_order(PlayOrder::kRandom, 10, 29, 3, 4));
  EXPECT_NE(random, steps_in_order(PlayOrder::kRandom, 10, 29, 3, 5));
  for (const std::uint32_t step : random) EXPECT_TRUE(step >= 10 && step <= 29);
}

}  // namespace
}  // namespace adamas
