#include "interfaces/resampling/interface_comparison.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/interfaces/network_meshes.h"

namespace adamas::interfaces {
namespace {

constexpr double kTarget = 0.06;

/// Two balls of different materials, as triangles much smaller than the target.
InterfaceMesh two_balls(double grown) {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  test::add_sphere(mesh, {0.3, 0.35, 0.4}, 0.2 + grown, MaterialId(0), MaterialId(1), 24);
  test::add_sphere(mesh, {0.7, 0.6, 0.55}, 0.17 + grown, MaterialId(0), MaterialId(2), 24);
  return mesh;
}

/// Moves some points by up to `by` along each axis.
void move_points(InterfaceMesh& mesh, std::size_t count, double by, std::mt19937_64& random) {
  std::uniform_real_distribution<double> offset(-by, by);
  for (std::size_t i = 0; i < count; ++i)
    mesh.points[random() % mesh.points.size()] += Vec3{offset(random), offset(random), offset(random)};
}

void expect_equal_measurements(const InterfaceComparison& a, const InterfaceComparison& b,
                               std::size_t triangles) {
  EXPECT_EQ(a.within(), b.within());
  EXPECT_DOUBLE_EQ(a.greatest(), b.greatest());
  EXPECT_EQ(a.far_shown(), b.far_shown());
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (std::size_t side = 0; side < 2; ++side) ASSERT_EQ(a.too_far(t, side), b.too_far(t, side)) << t;
  }
}

/// Measuring again only what changes may have touched gives what measuring all gives.
TEST(InterfaceComparison, ChangesAreMeasuredLikeAll) {
  const InterfaceMesh input = two_balls(0);
  std::mt19937_64 random(5);
  InterfaceMesh shown = two_balls(0.8 * kTarget);  // away from the input, but within the target
  InterfaceComparison changing(input, test::unit_box(), true, kTarget);
  EXPECT_TRUE(changing.measures_all());
  std::size_t far = 0;
  for (int round = 0; round < 24; ++round) {
    SCOPED_TRACE(round);
    InterfaceComparison fresh(input, test::unit_box(), true, kTarget);
    changing.measure(shown, SilentProgress::instance());
    fresh.measure(shown, SilentProgress::instance());
    EXPECT_FALSE(changing.measures_all());
    expect_equal_measurements(changing, fresh, input.triangles.size());
    far += fresh.far_shown().size();
    if (round % 5 == 4) {
      const InterfaceCertificate ours = changing.finish(SilentProgress::instance());
      const InterfaceCertificate theirs = fresh.finish(SilentProgress::instance());
      EXPECT_LE(ours.materials.lower, theirs.materials.upper);
      EXPECT_LE(theirs.materials.lower, ours.materials.upper);
      EXPECT_LE(ours.networks.lower, theirs.networks.upper);
      EXPECT_LE(theirs.networks.lower, ours.networks.upper);
      EXPECT_LE(ours.networks.lower, ours.networks.upper);
    }
    // Few points move, some of them too far; in some rounds a hole opens, in the next it closes.
    move_points(shown, 20, round % 3 == 0 ? kTarget : 0.2 * kTarget, random);
    shown.triangles = input.triangles;
    if (round % 2 == 0) {
      const Vec3 middle = shown.points[random() % shown.points.size()];
      std::erase_if(shown.triangles, [&](const InterfaceTriangle& t) {
        return distance(shown.points[t.points[0]], middle) < 2 * kTarget;
      });
    }
    if (round == 12) move_points(shown, shown.points.size(), 0.1 * kTarget, random);
  }
  EXPECT_GT(far, 0u);
}

/// A measurement of the greatest distance alone has no bounds of triangles that could be kept.
TEST(InterfaceComparison, AllIsMeasuredAfterTheGreatestDistanceAlone) {
  const InterfaceMesh input = two_balls(0);
  std::mt19937_64 random(7);
  InterfaceMesh shown = two_balls(0.8 * kTarget);
  InterfaceComparison changing(input, test::unit_box(), true, kTarget);
  for (int round = 0; round < 3; ++round) {
    SCOPED_TRACE(round);
    changing.measure(shown, SilentProgress::instance());
    EXPECT_FALSE(changing.measures_all());
    changing.measure(shown, SilentProgress::instance(), false);
    EXPECT_TRUE(changing.measures_all());
    move_points(shown, 20, kTarget, random);
    changing.measure(shown, SilentProgress::instance());
    InterfaceComparison fresh(input, test::unit_box(), true, kTarget);
    fresh.measure(shown, SilentProgress::instance());
    expect_equal_measurements(changing, fresh, input.triangles.size());
  }
}

}  // namespace
}  // namespace adamas::interfaces
