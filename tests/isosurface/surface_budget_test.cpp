#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/error.h"
#include "isosurface/contour/contour_clip.h"
#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::Dimensions;
using test::MemoryVolume;
using test::OpenStore;

MemoryVolume<std::uint16_t> hills(const Dimensions& dimensions) {
  return {dimensions,
          [random = std::mt19937(6)](LatticePoint p) mutable {
            return 20000 + 9000 * std::sin(0.25 * p.i + 0.1 * p.k) * std::cos(0.2 * p.j + 0.05 * p.k) +
                   static_cast<double>(random() % 200);
          },
          {1, 1.25, 0.8}};
}

SurfaceRequest request_of(double isovalue, std::uint64_t most, double error = 0) {
  SurfaceRequest request;
  request.isovalue = isovalue;
  request.error = error;
  request.max_triangles = most;
  return request;
}

/// There are never more triangles than asked for, except in the coarsest mesh, and the error falls as their
/// number grows.
TEST(SurfaceBudget, IsKeptForEveryNumber) {
  for (const Dimensions& box : std::vector<Dimensions>{{17, 17, 17}, {24, 17, 20}}) {
    const MemoryVolume<std::uint16_t> volume = hills(box);
    OpenStore<std::uint16_t> store(volume);
    const std::size_t floor = store.extract(20100, 1e9).contour.triangles.size();
    double last_error = std::numeric_limits<double>::infinity();
    for (std::uint64_t most = 0; most <= 300; most += most < 60 ? 1 : 7) {
      const ExtractedSurface surface = store.extract(request_of(20100, most));
      ASSERT_LE(surface.contour.triangles.size(), std::max<std::uint64_t>(most, floor)) << most;
      ASSERT_LE(surface.max_error, last_error) << most;
      last_error = surface.max_error;
      test::expect_sound(surface.contour, volume.grid.box());
      ASSERT_FALSE(HasFailure()) << most;
    }
  }
}

TEST(SurfaceBudget, LargeOnesAreUsedUp) {
  const MemoryVolume<std::uint16_t> volume = hills({40, 35, 65});
  OpenStore<std::uint16_t> store(volume);
  const std::size_t all = store.extract(20100).contour.triangles.size();
  std::mt19937 random(2);
  double last_error = std::numeric_limits<double>::infinity();
  std::vector<std::uint64_t> numbers;
  for (int n = 0; n < 5; ++n) numbers.push_back(2000 + random() % (all - 2000));
  std::sort(numbers.begin(), numbers.end());
  for (const std::uint64_t most : numbers) {
    const ExtractedSurface surface = store.extract(request_of(20100, most));
    EXPECT_LE(surface.contour.triangles.size(), most);
    EXPECT_GE(static_cast<double>(surface.contour.triangles.size()), 0.95 * static_cast<double>(most));
    EXPECT_LE(surface.max_error, last_error);
    last_error = surface.max_error;
  }
}

TEST(SurfaceBudget, AsManyAsThereAreGiveAll) {
  OpenStore<std::uint16_t> store(hills({33, 33, 33}));
  const ExtractedSurface all = store.extract(20100);
  const std::size_t count = all.contour.triangles.size();
  const ExtractedSurface same = store.extract(request_of(20100, count));
  EXPECT_EQ(same.contour, all.contour);
  EXPECT_EQ(same.max_error, 0);
  const ExtractedSurface fewer = store.extract(request_of(20100, count - 1));
  EXPECT_LT(fewer.contour.triangles.size(), count);
  EXPECT_GT(fewer.max_error, 0);
}

TEST(SurfaceBudget, TheErrorIsKeptToo) {
  OpenStore<std::uint16_t> store(hills({33, 30, 20}));
  for (const double error : {0.3, 1.0, 5.0}) {
    const ExtractedSurface by_error = store.extract(20100, error);
    const std::size_t enough = by_error.contour.triangles.size();
    // Where the budget is large enough the error decides.
    EXPECT_EQ(store.extract(request_of(20100, 2 * enough, error)).contour, by_error.contour);
    const ExtractedSurface fewer = store.extract(request_of(20100, enough / 2, error));
    EXPECT_LE(fewer.contour.triangles.size(), enough / 2);
    EXPECT_GT(fewer.max_error, error);
    EXPECT_LE(by_error.max_error, error);
  }
}

/// The surface of a region is the part of the whole surface that lies in it.
TEST(SurfaceRegion, IsThePartInTheBox) {
  const MemoryVolume<std::uint16_t> volume = hills({50, 33, 40});
  OpenStore<std::uint16_t> store(volume);
  SurfaceRequest request;
  request.isovalue = 20100;
  const ExtractedSurface whole = store.extract(request);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(0, 1);
  const Box3 ends = volume.grid.box();
  for (int turn = 0; turn < 12; ++turn) {
    Box3 region;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = number(random), b = number(random), size = ends.size()[axis];
      // Some regions extend beyond the data, and some have planes through samples.
      region.min[axis] = ends.min[axis] + size * (turn % 4 == 0 ? a - 0.5 : std::min(a, b));
      region.max[axis] = ends.min[axis] + size * (turn % 4 == 0 ? a + 0.4 : std::max(a, b));
      if (turn % 4 == 1)
        region.min[axis] =
            volume.grid.spacing[axis] * std::floor(region.min[axis] / volume.grid.spacing[axis]);
    }
    request.region = region;
    const ExtractedSurface part = store.extract(request);
    Contour wanted = whole.contour;
    clip_contour(wanted, region);
    test::expect_near(test::measure(part.contour), test::measure(wanted),
                      1e-8 * (1 + test::measure(whole.contour).area));
    Box3 both;
    for (int axis = 0; axis < 3; ++axis) {
      both.min[axis] = std::max(region.min[axis], ends.min[axis]);
      both.max[axis] = std::min(region.max[axis], ends.max[axis]);
    }
    test::expect_closed(part.contour, both);
    request.error = 1.5;
    test::expect_closed(store.extract(request).contour, both);
    request.error = 0;
    for (const std::uint64_t most : {50u, 400u}) {
      request.max_triangles = most;
      const ExtractedSurface few = store.extract(request);
      EXPECT_TRUE(few.contour.triangles.size() <= most || few.diamonds == 0);
      test::expect_closed(few.contour, both);
    }
    request.max_triangles.reset();
    ASSERT_FALSE(HasFailure()) << turn;
  }
}

TEST(SurfaceRegion, ReadsFewerPages) {
  const MemoryVolume<std::uint16_t> volume = hills({100, 90, 80});
  OpenStore<std::uint16_t> store(volume);
  SurfaceRequest request;
  request.isovalue = 20100;
  request.region = Box3{{20, 20, 20}, {27, 27, 27}};
  EXPECT_FALSE(store.extract(request).contour.triangles.empty());
  const PageReads few = store.pages().counts();
  request.region.reset();
  store.extract(request);
  const PageReads all = store.pages().counts();
  EXPECT_LT(3 * (few.pages + few.predictors), all.pages + all.predictors);
  store.open();
  request.region = Box3{{500, 20, 20}, {600, 27, 27}};
  EXPECT_TRUE(store.extract(request).contour.triangles.empty());
}

}  // namespace
}  // namespace adamas
