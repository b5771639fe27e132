#include "timevarying/surface_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "isosurface/extraction/surface_extractor.h"
#include "tests/support/surface_distance.h"
#include "tests/support/test_series.h"
#include "timevarying/step_pages.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using test::MemoryVolume;
using test::Motion;
using test::TestSeries;
using test::with_blocks;

/// Returns a ball with a given middle, as the signed distance from its surface.
MemoryVolume<float> ball(const Vec3& middle) {
  return {{40, 36, 33}, [&](LatticePoint p) {
            const Vec3 q{static_cast<double>(p.i), static_cast<double>(p.j), static_cast<double>(p.k)};
            return 9.3 - norm(q - middle);
          }};
}

template <class Sample>
Contour surface_at(StoreFile& file, std::uint32_t step, double isovalue) {
  SeriesPages<OrderedWord<Sample>> pages(file, step, std::size_t{1} << 26);
  SurfaceRequest request;
  request.isovalue = isovalue;
  return SurfaceExtractor<Sample>(pages).extract(request).contour;
}

TEST(SurfaceMotion, OfABallIsThatOfItsMiddle) {
  const test::Scratch folder;
  TestSeries<float> series({2, 2, 2}, Motion::kStill, 0);
  const std::vector<Vec3> ways{{0.4, 0, 0}, {0, -1.3, 0.9}, {0.1, 0.1, 0.1}, {0, 0, 0}};
  Vec3 middle{18.2, 17.9, 16.4};
  series.steps.push_back(ball(middle));
  for (const Vec3& way : ways) series.steps.push_back(ball(middle += way));
  build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(8));
  StoreFile file(folder / "a.adm");
  const std::unique_ptr<SurfaceMotion> motion = SurfaceMotion::open(file, std::size_t{1} << 26);
  // The error of linear interpolation of distances is below this.
  constexpr double kOff = 0.06;
  for (std::uint32_t step = 0; step < ways.size(); ++step) {
    const SurfaceCertificate found = motion->between(step, step + 1, 0);
    EXPECT_NEAR(found.found, norm(ways[step]), kOff);
    EXPECT_GE(found.certified, norm(ways[step]) - kOff);
    EXPECT_LE(found.certified, norm(ways[step]) + 2 * kOff);
    EXPECT_LE(found.found, found.certified);
  }
  EXPECT_TRUE(motion->is_same_surface(3, 4, 0));
  EXPECT_FALSE(motion->is_same_surface(2, 3, 0));
  EXPECT_EQ(motion->between(3, 4, 0).certified, 0);
  EXPECT_TRUE(std::isinf(motion->between(0, 1, 1000).certified) || motion->is_same_surface(0, 1, 1000));
}

/// No sampled point of either surface is farther from the other than the certified distance, and the distance
/// that was found is not greater than that either.
TEST(SurfaceMotion, BoundsAllSampledDistances) {
  const test::Scratch folder;
  const TestSeries<std::uint8_t> series({36, 33, 20}, Motion::kWaves, 10);
  build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(32));
  StoreFile file(folder / "a.adm");
  const std::unique_ptr<SurfaceMotion> motion = SurfaceMotion::open(file, std::size_t{1} << 26);
  for (const auto& [from, to] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}, {8, 7}, {2, 9}}) {
    SCOPED_TRACE(testing::Message() << from << " to " << to);
    const Contour a = surface_at<std::uint8_t>(file, from, 60.5),
                  b = surface_at<std::uint8_t>(file, to, 60.5);
    ASSERT_GT(a.triangles.size(), 1000u);
    const SurfaceCertificate found = motion->between(from, to, 60.5);
    const double sampled = test::sampled_distance(a.points, a.triangles, b.points, b.triangles,
                                                  series.steps[0].grid.box(), 20'000, from);
    EXPECT_LE(sampled, found.certified);
    EXPECT_GT(sampled, 0.3 * found.found);
    EXPECT_LE(found.found, found.certified);
    EXPECT_GT(found.found, 0);
    EXPECT_FALSE(motion->is_same_surface(from, to, 60.5));
  }
}

/// Where the surface is reported to stand still, it does so.
TEST(SurfaceMotion, IsNothingWhereASeriesStandsStill) {
  const test::Scratch folder;
  TestSeries<float> series({2, 2, 2}, Motion::kStill, 0);
  for (int step = 0; step < 12; ++step) {
    // Far from the ball something moves, which in some steps is large enough for a surface of its own.
    series.steps.emplace_back(test::Dimensions{90, 33, 33}, [step](LatticePoint p) {
      const Vec3 q{static_cast<double>(p.i), static_cast<double>(p.j), static_cast<double>(p.k)};
      const double moving = step % 4 == 0 ? 3 : 0.1 * step;
      return std::max(9.3 - norm(q - Vec3{70, 16, 16}), moving - norm(q - Vec3{4, 5, 6}));
    });
  }
  build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(32));
  StoreFile file(folder / "a.adm");
  const std::unique_ptr<SurfaceMotion> motion = SurfaceMotion::open(file, std::size_t{1} << 26);
  std::size_t still = 0, moving = 0;
  for (std::uint32_t step = 1; step < 12; ++step) {
    for (const double isovalue : {0.05, 5.0}) {
      const Contour a = surface_at<float>(file, step - 1, isovalue),
                    b = surface_at<float>(file, step, isovalue);
      ASSERT_GT(a.triangles.size(), 100u);
      const bool is_same_surface = motion->is_same_surface(step - 1, step, isovalue);
      EXPECT_EQ(is_same_surface, motion->is_same_surface(step, step - 1, isovalue));
      (is_same_surface ? still : moving) += 1;
      if (!is_same_surface) continue;
      EXPECT_EQ(a.points, b.points);
      EXPECT_EQ(a.triangles, b.triangles);
      EXPECT_EQ(motion->between(step - 1, step, isovalue).certified, 0);
    }
  }
  // At isovalue 5 nothing moves, at 0.05 something always does.
  EXPECT_EQ(still, 11u);
  EXPECT_EQ(moving, 11u);
}

/// From each step to the next one sample changes, anywhere. The surface is reported to stand still only where
/// it does so, whether steps are coded as whole ones or not.
TEST(SurfaceMotion, OfOneSampleIsNotOverlooked) {
  const test::Scratch folder;
  TestSeries<std::uint8_t> series({36, 33, 20}, Motion::kWaves, 1);
  std::mt19937 random(8);
  for (int step = 1; step < 40; ++step) {
    MemoryVolume<std::uint8_t> next = series.steps.back();
    std::uint8_t& sample = next.samples[random() % next.samples.size()];
    sample = static_cast<std::uint8_t>(random() % 2 == 0 ? sample + 1 : 60 + random() % 3);
    series.steps.push_back(std::move(next));
  }
  build_series(folder / "a.adm", "a.adm", series.source(), with_blocks(10));
  StoreFile file(folder / "a.adm");
  const std::unique_ptr<SurfaceMotion> motion = SurfaceMotion::open(file, std::size_t{1} << 26);
  std::size_t still = 0, found = 0, moving = 0;
  for (std::uint32_t step = 1; step < 40; ++step) {
    for (const double isovalue : {60.5, 89.5}) {
      const Contour a = surface_at<std::uint8_t>(file, step - 1, isovalue),
                    b = surface_at<std::uint8_t>(file, step, isovalue);
      const bool is_same = a.points == b.points && a.triangles == b.triangles;
      const bool is_same_surface = motion->is_same_surface(step - 1, step, isovalue);
      EXPECT_TRUE(is_same || !is_same_surface) << "step " << step << " at " << isovalue;
      (is_same ? still : moving) += 1;
      found += is_same_surface ? 1 : 0;
    }
  }
  EXPECT_GT(moving, 9u);
  EXPECT_GT(still, 9u);
  EXPECT_GT(found, 0u);
}

}  // namespace
}  // namespace adamas
