#include "isosurface/extraction/surface_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "tests/isosurface/surface_checks.h"

namespace adamas {

using namespace isosurface;

namespace {

using test::Dimensions;
using test::MemoryVolume;
using test::OpenStore;

template <class Sample>
std::vector<Vec3> normals_of(OpenStore<Sample>& store, const Contour& contour) {
  const auto [normals, lost] = surface_normals<Sample>(store.pages(), contour);
  EXPECT_TRUE(lost.empty());
  EXPECT_EQ(normals.size(), contour.points.size());
  for (const Vec3& n : normals) {
    const double length = norm(n);
    EXPECT_TRUE(length == 0 || std::abs(length - 1) < 1e-12);
  }
  return normals;
}

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

/// The data are at least as thick as the mesh is coarse; otherwise a point would have no neighbours along
/// some axis.
TEST(SurfaceNormals, OfLinearDataAreExact) {
  for (const Dimensions& box : std::vector<Dimensions>{{9, 9, 9}, {17, 17, 17}, {33, 33, 33}}) {
    const Vec3 slope{3, -2, 5}, spacing{1, 0.5, 2};
    const MemoryVolume<float> volume(
        box,
        [&](LatticePoint p) {
          return slope.x * spacing.x * p.i + slope.y * spacing.y * p.j + slope.z * spacing.z * p.k;
        },
        spacing);
    OpenStore<float> store(volume);
    const auto [low, high] = store.extractor().range();
    const Contour contour = store.extract(0.4 * low + 0.6 * high).contour;
    EXPECT_FALSE(contour.points.empty());
    const std::vector<Vec3> normals = normals_of(store, contour);
    for (const Vec3& n : normals) ASSERT_LT(degrees_between(n, -slope), 0.001);
  }
}

TEST(SurfaceNormals, OfASphereAreRadial) {
  const Vec3 centre{15.3, 15.6, 16.1};
  const MemoryVolume<float> volume({33, 32, 35}, [&](LatticePoint p) {
    return 100 - 3 * norm(Vec3{double(p.i), double(p.j), double(p.k)} - centre);
  });
  OpenStore<float> store(volume);
  for (const double error : {0.0, 0.05}) {
    const Contour contour = store.extract(70, error).contour;
    const std::vector<Vec3> normals = normals_of(store, contour);
    for (std::size_t n = 0; n < normals.size(); ++n)
      ASSERT_LT(degrees_between(normals[n], contour.points[n] - centre), error == 0 ? 2 : 6) << error;
  }
  // Normals point to the same side as those of the triangles.
  const Contour contour = store.extract(70).contour;
  const std::vector<Vec3> normals = normals_of(store, contour);
  for (const auto& [a, b, c] : contour.triangles) {
    const Vec3 own = cross(contour.points[b] - contour.points[a], contour.points[c] - contour.points[a]);
    ASSERT_GT(dot(own, normals[a] + normals[b] + normals[c]), 0);
  }
}

template <class Sample>
class SurfaceNormalsOf : public testing::Test {};
using Samples = testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(SurfaceNormalsOf, Samples);

TYPED_TEST(SurfaceNormalsOf, AreOfLengthOneOrZero) {
  for (const Dimensions& box : std::vector<Dimensions>{{2, 2, 2}, {20, 11, 14}}) {
    const MemoryVolume<TypeParam> volume(
        box, [random = std::mt19937(3)](LatticePoint) mutable { return random() % 3; });
    OpenStore<TypeParam> store(volume);
    for (const double error : {0.0, 1.0, 1e9}) normals_of(store, store.extract(1, error).contour);
  }
}

TEST(SurfaceNormals, HolesDoNotSpoilThem) {
  const MemoryVolume<float> volume({17, 17, 17}, [random = std::mt19937(3)](LatticePoint p) mutable {
    return random() % 40 == 0 ? std::nan("") : 2.0 * p.i + p.j + 3.0 * p.k;
  });
  OpenStore<float> store(volume);
  const Contour contour = store.extract(40.5).contour;
  const std::vector<Vec3> normals = normals_of(store, contour);
  std::size_t exact = 0;
  for (const Vec3& n : normals) exact += degrees_between(n, {-2, -1, -3}) < 0.01 ? 1 : 0;
  EXPECT_EQ(exact, normals.size());
}

}  // namespace
}  // namespace adamas
