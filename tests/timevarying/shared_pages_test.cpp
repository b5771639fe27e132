#include "timevarying/shared_pages.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "isosurface/view/paged_frames.h"
#include "tests/isosurface/frame_checks.h"
#include "tests/support/test_series.h"
#include "timevarying/series_frames.h"
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

constexpr std::uint32_t kSteps = 40;
const std::vector<double> kIsovalues{45.5, 60.5, 75.5};

/// Frames of several isovalues that share one memory of pages.
class SharedFrames : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    StoreOptions options;
    options.gradients = GetParam();
    options.block_steps = 8;
    const TestSeries<std::uint8_t> series({36, 33, 20}, Motion::kWaves, kSteps);
    build_series(path_, "a.adm", series.source(), options);
    box_ = series.steps[0].grid.box();
    file_ = std::make_unique<StoreFile>(path_);
  }
  void open(std::size_t memory) {
    shared_ = SharedPages::open(*file_, memory);
    for (std::size_t n = 0; n < kIsovalues.size(); ++n) frames_.push_back(SeriesFrames::open(*shared_));
  }
  /// Expects the frames that begin at the step, with pages of their own.
  void expect_fresh(const SeriesFrames& frames, std::uint32_t step, FrameRequest wanted) const {
    StoreFile file(path_);
    SeriesPages<std::uint8_t> pages(file, step, std::size_t{1} << 26);
    PagedFrames<std::uint8_t> fresh(pages);
    wanted.resident_only = false;
    fresh.refine(wanted);
    Chunks chunks;
    frames.for_each_chunk([&](const SurfaceChunk& chunk) { chunks.emplace(chunk.id, chunk); });
    expect_same(chunks, test::chunks_of(fresh));
  }

  const test::Scratch folder_;
  const std::filesystem::path path_ = folder_ / "a.adm";
  Box3 box_;
  std::unique_ptr<StoreFile> file_;
  std::unique_ptr<SharedPages> shared_;
  std::vector<std::unique_ptr<SeriesFrames>> frames_;
};

/// Some frames are behind others by more steps than stay in memory.
TEST_P(SharedFrames, AreThoseOfPagesOfTheirOwn) {
  open(0);
  CameraPath path(box_, 7);
  std::uint32_t step = 0;
  for (int n = 0; n < 60; ++n) {
    FrameRequest wanted;
    wanted.viewpoint = path.next();
    wanted.pixels = 0.5 * (1 + path.number(8));
    step = (step + 1 + path.number(2)) % kSteps;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      if (f > 0 && n % 50 != 49) continue;
      SCOPED_TRACE(testing::Message() << "frame " << n << " step " << step << " of " << f);
      wanted.isovalue = kIsovalues[f];
      frames_[f]->next(step, wanted);
      if (n % 7 == 0 || f > 0) expect_fresh(*frames_[f], step, wanted);
    }
    if (HasFailure()) return;
  }
}

TEST_P(SharedFrames, OfResidentPagesComeToBeThoseThatWait) {
  open(1 << 26);
  CameraPath path(box_, 8);
  FrameRequest wanted;
  wanted.resident_only = true;
  for (std::uint32_t step = 3; step < 6; ++step) {
    wanted.viewpoint = path.next();
    const auto all_missing = [&] {
      std::uint64_t missing = 0;
      for (std::size_t f = 0; f < frames_.size(); ++f) {
        wanted.isovalue = kIsovalues[f];
        missing += frames_[f]->next(step, wanted).pages_missing;
      }
      return missing;
    };
    for (int looks = 0; all_missing() > 0 && looks < 10'000; ++looks) frames_.back()->wait();
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      wanted.isovalue = kIsovalues[f];
      EXPECT_FALSE(frames_[f]->is_paging());
      expect_fresh(*frames_[f], step, wanted);
    }
  }
  // The other frames go on after one of them is destroyed.
  frames_.erase(frames_.begin());
  wanted.viewpoint = path.next();
  for (int looks = 0; frames_[0]->next(8, wanted).pages_missing > 0 && looks < 10'000; ++looks)
    frames_[0]->wait();
  expect_fresh(*frames_[0], 8, wanted);
}

INSTANTIATE_TEST_SUITE_P(Gradients, SharedFrames, testing::Bool());

TEST(SharedPages, AreReadOnceForAllIsovalues) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({100, 90, 80}, Motion::kWaves, 1);
  build_series(folder / "a.adm", "a.adm", series.source(), {});
  FrameRequest wanted;
  wanted.viewpoint.target = series.steps[0].grid.box().center();
  wanted.viewpoint.eye = wanted.viewpoint.target + Vec3{100, 90, 110};
  const auto pages_read = [&](std::size_t isovalues, bool is_shared) {
    std::uint64_t pages = 0;
    StoreFile file(folder / "a.adm");
    auto shared = SharedPages::open(file, std::size_t{1} << 28);
    for (std::size_t n = 0; n < isovalues; ++n) {
      wanted.isovalue = kIsovalues[n];
      SeriesFrames::open(*shared)->next(0, wanted);
      if (is_shared && n + 1 < isovalues) continue;
      pages += shared->counts().pages + shared->counts().predictors;
      shared = SharedPages::open(file, std::size_t{1} << 28);
    }
    return pages;
  };
  EXPECT_EQ(pages_read(1, true), pages_read(1, false));
  EXPECT_LT(2 * pages_read(3, true), pages_read(3, false));
}

TEST(LongSharedPages, NeverTakeMoreThanTheirMemory) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({140, 130, 120}, Motion::kWaves, 2);
  build_series(folder / "a.adm", "a.adm", series.source(), {});
  StoreFile file(folder / "a.adm");
  constexpr std::size_t kMemory = std::size_t{4} << 20;
  const auto shared = SharedPages::open(file, kMemory);
  std::vector<std::unique_ptr<SeriesFrames>> frames;
  FrameRequest wanted;
  wanted.pixels = 0.1;
  wanted.viewpoint.target = series.steps[0].grid.box().center();
  wanted.viewpoint.eye = wanted.viewpoint.target + Vec3{100, 90, 110};
  for (const double isovalue : kIsovalues) {
    frames.push_back(SeriesFrames::open(*shared));
    for (const std::uint32_t step : {0, 1}) {
      for (std::size_t n = 0; n < frames.size(); ++n) {
        wanted.isovalue = kIsovalues[n];
        frames[n]->next(step, wanted);
        EXPECT_LE(shared->bytes_held(), kMemory) << isovalue;
      }
    }
  }
  EXPECT_GT(shared->bytes_held(), kMemory / 10 * 9) << "there are more pages than fit";
}

}  // namespace
}  // namespace adamas
