#include <gtest/gtest.h>

#include <random>

#include "isosurface/view/paged_frames.h"
#include "tests/isosurface/frame_checks.h"
#include "tests/isosurface/surface_checks.h"
#include "tests/support/test_series.h"
#include "timevarying/step_pages.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::CameraPath;
using test::chunks_of;
using test::expect_same;
using test::Motion;
using test::TestSeries;
using test::with_blocks;

class StepFrames : public testing::Test {
 protected:
  template <class Sample>
  void walk(unsigned seed, Motion motion, std::size_t memory, bool with_gradients = false);
};

/// Walks through time, errors, isovalues and cameras, stops some frames, and expects that each surface is
/// that of frames that begin at its step.
template <class Sample>
void StepFrames::walk(unsigned seed, Motion motion, std::size_t memory, bool with_gradients) {
  using Word = OrderedWord<Sample>;
  const test::Scratch folder;
  const TestSeries<Sample> series({36, 33, 20}, motion, 19);
  StoreOptions options = with_blocks(10);
  options.gradients = with_gradients;
  build_series(folder / "a.adm", "a.adm", series.source(), options);
  StoreFile file(folder / "a.adm"), other(folder / "a.adm");
  StepPages<Word> steps(file, memory);
  PagedFrames<Sample> frames(steps.at(0), 1 << 14);
  CameraPath path(series.steps[0].grid.box(), seed);
  std::uint32_t step = 0;
  std::size_t stopped = 0, moved = 0;
  double isovalue = 60.5;
  for (int n = 0; n < 24; ++n) {
    SCOPED_TRACE(testing::Message() << "frame " << n << " step " << step);
    if (path.number(4) == 0) isovalue = 45.5 + path.number(3) * 15;
    FrameRequest wanted;
    wanted.viewpoint = path.next();
    wanted.isovalue = isovalue;
    wanted.pixels = 0.5 * (1 + path.number(8));
    if (path.number(3) == 0) wanted.max_triangles = 40 + path.number(12000);
    const std::uint32_t looks = 1 + path.number(60);
    std::uint32_t done = 0;
    if (path.number(4) == 0) wanted.stop = [&] { return ++done >= looks; };
    if (path.number(3) != 0) {
      step = path.number(3) == 0 ? path.number(19) : (step + path.number(3) + 18) % 19;
      ++moved;
    }
    frames.set_pages(steps.at(step));
    const auto before = chunks_of(frames);
    const FrameFigures figures = frames.refine(wanted);
    test::expect_sound(frames.contour(), series.steps[0].grid.box());
    if (figures.stopped) {
      ++stopped;
      if (chunks_of(frames).size() > 1) expect_same(chunks_of(frames), before);
      continue;
    }
    SeriesPages<Word> pages(other, step, std::size_t{1} << 26);
    PagedFrames<Sample> fresh(pages);
    wanted.stop = nullptr;
    const FrameFigures expected = fresh.refine(wanted);
    expect_same(chunks_of(frames), chunks_of(fresh));
    EXPECT_EQ(figures.triangles, expected.triangles);
    EXPECT_EQ(figures.largest_error, expected.largest_error);
    if (HasFailure()) return;
  }
  EXPECT_GT(moved, 10u);
  EXPECT_GT(stopped, 0u);
}

TEST_F(StepFrames, AreThoseOfTheStepAlone) {
  walk<std::uint8_t>(1, Motion::kWaves, std::size_t{1} << 26);
  walk<std::uint8_t>(2, Motion::kStill, std::size_t{1} << 26);
  walk<float>(3, Motion::kWaves, std::size_t{1} << 26);
}

TEST_F(StepFrames, AreThoseOfTheStepAloneInLittleMemory) {
  walk<std::uint16_t>(4, Motion::kWaves, 0);
  walk<std::int16_t>(5, Motion::kLinear, 0);
}

TEST_F(StepFrames, AreThoseOfTheStepAloneWithStoredGradients) {
  walk<std::uint8_t>(6, Motion::kWaves, std::size_t{1} << 26, true);
}

}  // namespace
}  // namespace adamas
