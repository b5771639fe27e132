#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/isosurface/contour_checks.h"
#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::Dimensions;
using test::MemoryVolume;
using test::OpenStore;

const std::vector<Dimensions> kBoxes{{9, 9, 9}, {17, 17, 17}, {18, 17, 9},  {33, 5, 12}, {2, 2, 2},
                                     {3, 2, 7}, {4, 31, 6},   {10, 10, 34}, {16, 2, 2},  {5, 40, 21}};

/// Expects sound surfaces for errors from 0 to more than occur.
template <class Sample>
void expect_sound_surfaces(const MemoryVolume<Sample>& volume, const std::vector<double>& isovalues) {
  OpenStore<Sample> store(volume);
  for (const double isovalue : isovalues) {
    for (const double error : {0.0, 0.4, 2.0, 1e9}) {
      SCOPED_TRACE(testing::Message()
                   << volume.grid.dimensions[0] << " x " << volume.grid.dimensions[1] << " x "
                   << volume.grid.dimensions[2] << " isovalue " << isovalue << ", error " << error);
      const ExtractedSurface surface = store.extract(isovalue, error);
      test::expect_sound(surface.contour, volume.grid.box());
      EXPECT_LE(surface.max_error, error);
      EXPECT_TRUE(surface.lost.empty());
      if (testing::Test::HasFailure()) return;
    }
  }
}

template <class Sample>
class SurfaceBorderOf : public testing::Test {};
using Samples = testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(SurfaceBorderOf, Samples);

/// With only a few values many samples equal the isovalue, and there are plateaus.
TYPED_TEST(SurfaceBorderOf, SamplesEqualToTheIsovalue) {
  for (const Dimensions& box : kBoxes) {
    std::mt19937 random(4);
    expect_sound_surfaces(MemoryVolume<TypeParam>(box, [&](LatticePoint) { return random() % 3; },
                                                  {1, 0.5, 2}, {-3, 0.125, 1e3}),
                          {0, 1, 2, 3, 0.5});
    expect_sound_surfaces(
        MemoryVolume<TypeParam>(box, [](LatticePoint p) { return (p.i / 4 + p.j / 3 + p.k / 5) % 3; }),
        {1, 2, 1.5});
    if (testing::Test::HasFailure()) return;
  }
}

TYPED_TEST(SurfaceBorderOf, SmoothFields) {
  for (const Dimensions& box : kBoxes) {
    expect_sound_surfaces(
        MemoryVolume<TypeParam>(
            box,
            [&](LatticePoint p) { return 100 + 60 * std::sin(0.5 * p.i + 0.2 * p.k) * std::cos(0.4 * p.j); },
            {2, 1, 0.75}),
        {70.5, 100, 131});
    if (testing::Test::HasFailure()) return;
  }
}

TYPED_TEST(SurfaceBorderOf, EmptyAtTheLeastAndBeyondTheRange) {
  const MemoryVolume<TypeParam> volume(
      {20, 11, 9}, [](LatticePoint p) { return 10 + (p.i * 7 + p.j * 5 + p.k * 3) % 50; });
  OpenStore<TypeParam> store(volume);
  EXPECT_EQ(store.extractor().range(), (std::array{10.0, 59.0}));
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double isovalue : {10.0, 9.5, -1e9, 59.01, 1e9, kInfinity, -kInfinity, std::nan("")}) {
    const ExtractedSurface surface = store.extract(isovalue);
    EXPECT_TRUE(surface.contour.triangles.empty()) << isovalue;
    EXPECT_TRUE(surface.contour.points.empty()) << isovalue;
    EXPECT_EQ(surface.diamonds, 0u) << isovalue;
  }
  const ExtractedSurface greatest = store.extract(59);
  EXPECT_FALSE(greatest.contour.triangles.empty());
  test::expect_sound(greatest.contour, volume.grid.box());
}

/// Where all samples are equal there is no surface at any isovalue.
TYPED_TEST(SurfaceBorderOf, EmptyInConstantData) {
  for (const Dimensions& box : std::vector<Dimensions>{{1, 1, 1}, {5, 5, 5}, {18, 7, 3}}) {
    OpenStore<TypeParam> store(MemoryVolume<TypeParam>(box, [](LatticePoint) { return 42; }));
    for (const double isovalue : {41.0, 42.0, 43.0})
      EXPECT_TRUE(store.extract(isovalue).contour.points.empty());
  }
}

TYPED_TEST(SurfaceBorderOf, EmptyWhereAnAxisHasOneSample) {
  for (const Dimensions& box : std::vector<Dimensions>{
           {1, 1, 1}, {2, 1, 1}, {3, 1, 1}, {1, 1, 9}, {1, 20, 3}, {17, 1, 4}, {33, 40, 1}, {2, 2, 1}}) {
    OpenStore<TypeParam> store(MemoryVolume<TypeParam>(
        box, [random = std::mt19937(1)](LatticePoint) mutable { return random() % 100; }));
    for (const double error : {0.0, 1.0, 1e9}) {
      const ExtractedSurface surface = store.extract(50, error);
      EXPECT_TRUE(surface.contour.triangles.empty());
    }
    SurfaceRequest few;
    few.isovalue = 50;
    few.max_triangles = 10;
    EXPECT_TRUE(store.extract(few).contour.triangles.empty());
  }
}

/// A plane ends exactly at the data's box, and there is no wall where the data end before the lattice does.
TEST(SurfaceBorder, PlanesEndAtTheBox) {
  for (const Dimensions& box : kBoxes) {
    const auto size = [&](std::size_t axis) { return static_cast<double>(box[axis] - 1); };
    for (int axis = 0; axis < 3; ++axis) {
      const MemoryVolume<float> volume(box, [&](LatticePoint p) { return 3 * p[axis] + 1; }, {0.5, 1, 2},
                                       {1, 2, 3});
      OpenStore<float> store(volume);
      const double isovalue = 1 + 3 * 0.375 * size(static_cast<std::size_t>(axis));
      const Contour contour = store.extract(isovalue).contour;
      test::expect_closed(contour, volume.grid.box());
      const Vec3 extent = volume.grid.box().size();
      const double area = extent.x * extent.y * extent.z / extent[axis];
      const test::SurfaceMeasure found = test::measure(contour);
      EXPECT_NEAR(found.area, area, 1e-9 * area);
      EXPECT_NEAR(found.vector[axis], -area, 1e-9 * area) << "towards values below";
      for (const Vec3& p : contour.points)
        ASSERT_NEAR(p[axis], volume.grid.box().min[axis] + 0.375 * extent[axis], 1e-9);
    }
  }
}

TEST(SurfaceBorder, ThereIsNoWallAtThePadding) {
  for (const Dimensions& box : kBoxes) {
    const MemoryVolume<std::uint8_t> volume(
        box, [random = std::mt19937(8)](LatticePoint) mutable { return random() % 200; });
    OpenStore<std::uint8_t> store(volume);
    for (const double error : {0.0, 0.5}) {
      const Contour contour = store.extract(100.5, error).contour;
      EXPECT_FALSE(contour.triangles.empty());
      const Box3 ends = volume.grid.box();
      for (const auto& triangle : contour.triangles) {
        for (int axis = 0; axis < 3; ++axis) {
          for (const double side : {ends.min[axis], ends.max[axis]}) {
            const auto in_side = [&](std::uint32_t p) { return contour.points[p][axis] == side; };
            ASSERT_FALSE(std::all_of(triangle.begin(), triangle.end(), in_side));
          }
        }
      }
    }
  }
}

/// Tetrahedra with a corner that is not a number have no surface, all others of the mesh have one.
TEST(SurfaceBorder, HolesWhereSamplesAreNotFinite) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const Dimensions& box : std::vector<Dimensions>{{9, 9, 9}, {18, 17, 9}, {20, 5, 33}}) {
    std::mt19937 random(3);
    const MemoryVolume<float> volume(box, [&](LatticePoint p) {
      switch (random() % 60) {
        case 0:
          return std::numeric_limits<float>::quiet_NaN();
        case 1:
          return kInfinity;
        case 2:
          return -kInfinity;
        default:
          return 100.0f + 60 * std::sin(0.5f * static_cast<float>(p.i + p.k)) +
                 static_cast<float>(random() % 100) / 100;
      }
    });
    OpenStore<float> store(volume);
    const test::DiamondTable table(store);
    const int depth = store.pages().grid().depth();
    for (const double isovalue : {80.0, 120.0}) {
      const Contour contour = store.extract(isovalue).contour;
      const auto field = test::field_of(volume, depth);
      for (const EdgePoint& p : contour.edge_points)
        ASSERT_TRUE(std::isfinite(field(p.first)) && std::isfinite(field(p.second)));
      const Contour wanted = extract_contour(table.mesh(isovalue, 0), field, isovalue,
                                             test::options_of(volume, depth, 1.0 / 1024));
      EXPECT_FALSE(wanted.triangles.empty());
      test::expect_near(test::measure(contour), test::measure(wanted), 1e-7 * test::measure(wanted).area);
    }
  }
}

}  // namespace
}  // namespace adamas
