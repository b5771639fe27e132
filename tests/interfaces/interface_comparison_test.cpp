#include "interfaces/resampling/interface_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <vector>

#include "core/distance/hausdorff.h"
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
  EXPECT_FALSE(changing.knows_each());
  std::size_t far = 0;
  for (int round = 0; round < 24; ++round) {
    SCOPED_TRACE(round);
    InterfaceComparison fresh(input, test::unit_box(), true, kTarget);
    changing.measure(shown, SilentProgress::instance());
    fresh.measure(shown, SilentProgress::instance());
    EXPECT_TRUE(changing.knows_each());
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

/// Two balls of different materials that nearly touch: what is shown of one may be closer to the other one
/// than to its own input.
InterfaceMesh near_balls(double grown, double apart) {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  test::add_sphere(mesh, {0.29 - apart, 0.5, 0.5}, 0.2 + grown, MaterialId(0), MaterialId(1), 16);
  test::add_sphere(mesh, {0.71 + apart, 0.5, 0.5}, 0.2 + grown, MaterialId(0), MaterialId(2), 16);
  return mesh;
}

/// Returns the triangles of a mesh that bound a material, and their numbers.
ClosestPointTree boundary(const InterfaceMesh& mesh, MaterialId material,
                          std::vector<std::uint32_t>& numbers) {
  std::vector<ClosestPointTree::Triangle> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const InterfaceTriangle& each = mesh.triangles[t];
    if (each.front != material && each.back != material) continue;
    triangles.push_back(each.points);
    numbers.push_back(t);
  }
  return {mesh.points, triangles};
}

/// What is measured for two materials at once is what each of them has alone.
TEST(InterfaceComparison, EachMaterialIsMeasuredAsIfItWereAlone) {
  std::mt19937_64 random(11);
  std::size_t far = 0;
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    const InterfaceMesh input = near_balls(0, 0);
    InterfaceMesh shown = near_balls(0.1 * kTarget * round, (round % 3) * 0.5 * kTarget);
    move_points(shown, 60, 0.5 * kTarget, random);
    InterfaceComparison comparison(input, test::unit_box(), false, kTarget);
    comparison.measure(shown, SilentProgress::instance());
    HausdorffOptions options;
    options.domain = test::unit_box();
    options.accept = kTarget;
    options.relative = 0.005;
    options.each = true;
    double greatest = 0;
    std::vector<std::array<bool, 2>> too_far(input.triangles.size());
    std::vector<char> far_shown(shown.triangles.size(), 0);
    for (MaterialId m(0); m.value < 3; ++m.value) {
      std::vector<std::uint32_t> of_input, of_shown;
      const ClosestPointTree before = boundary(input, m, of_input), now = boundary(shown, m, of_shown);
      const DistanceBound there = directed_distance_bound(TriangleList(before), now, options),
                          back = directed_distance_bound(TriangleList(now), before, options);
      greatest = std::max({greatest, there.upper, back.upper});
      for (std::size_t i = 0; i < of_input.size(); ++i) {
        const std::size_t side = input.triangles[of_input[i]].front == m ? 0 : 1;
        too_far[of_input[i]][side] = there.triangle_upper[i] > kTarget;
      }
      for (std::size_t i = 0; i < of_shown.size(); ++i)
        far_shown[of_shown[i]] = far_shown[of_shown[i]] != 0 || back.triangle_upper[i] > kTarget ? 1 : 0;
    }
    if (greatest > kTarget) {
      EXPECT_DOUBLE_EQ(comparison.greatest(), greatest);
    }
    EXPECT_EQ(comparison.within(), greatest <= kTarget);
    for (std::uint32_t t = 0; t < too_far.size(); ++t) {
      for (std::size_t side = 0; side < 2; ++side)
        ASSERT_EQ(comparison.too_far(t, side), too_far[t][side]) << t;
    }
    std::vector<std::uint32_t> expected;
    for (std::uint32_t t = 0; t < far_shown.size(); ++t) {
      if (far_shown[t] != 0) expected.push_back(t);
    }
    EXPECT_EQ(comparison.far_shown(), expected);
    far += expected.size();
  }
  EXPECT_GT(far, 0u);
}

/// Bounds that follow moves tell what is too far as a measurement of all does, where triangles come and go
/// and points get other numbers, too.
TEST(InterfaceComparison, MovedTrianglesAreMeasuredLikeAll) {
  const InterfaceMesh input = near_balls(0, 0);
  std::mt19937_64 random(13);
  InterfaceMesh shown = near_balls(0.5 * kTarget, 0);
  InterfaceComparison moving(input, test::unit_box(), false, kTarget);
  moving.measure(shown, SilentProgress::instance());
  std::size_t far = 0;
  for (int round = 0; round < 24; ++round) {
    SCOPED_TRACE(round);
    // Each point gets another number; some of them count as new.
    const auto count = static_cast<std::uint32_t>(shown.points.size());
    const std::uint32_t offset = 1 + static_cast<std::uint32_t>(random() % (count - 1));
    std::vector<std::uint32_t> before(count);
    InterfaceMesh next = shown;
    next.triangles = input.triangles;
    for (std::uint32_t p = 0; p < count; ++p) {
      before[(p + offset) % count] = random() % 64 == 0 ? InterfaceComparison::kNoPoint : p;
      next.points[(p + offset) % count] = shown.points[p];
    }
    move_points(next, 200, (round % 2 == 0 ? 0.1 : 0.6) * kTarget, random);
    const Vec3 middle = next.points[random() % count];
    const bool has_hole = round % 3 == 0;
    for (InterfaceTriangle& t : next.triangles) {
      for (std::uint32_t& p : t.points) p = (p + offset) % count;
    }
    if (has_hole) {
      std::erase_if(next.triangles, [&](const InterfaceTriangle& t) {
        return distance(next.points[t.points[0]], middle) < 1.5 * kTarget;
      });
    }
    moving.measure_moved(next, before, SilentProgress::instance());
    InterfaceComparison fresh(input, test::unit_box(), false, kTarget);
    fresh.measure(next, SilentProgress::instance());
    EXPECT_EQ(moving.within(), fresh.within());
    EXPECT_EQ(moving.far_shown(), fresh.far_shown());
    for (std::uint32_t t = 0; t < input.triangles.size(); ++t) {
      for (std::size_t side = 0; side < 2; ++side)
        ASSERT_EQ(moving.too_far(t, side), fresh.too_far(t, side)) << t;
    }
    far += fresh.far_shown().size();
    // The next round has the same triangles in the order of their first numbers.
    shown = near_balls(0.5 * kTarget, 0);
    move_points(shown, 100, 0.3 * kTarget, random);
    std::vector<std::uint32_t> back(count);
    for (std::uint32_t p = 0; p < count; ++p) back[p] = (p + offset) % count;
    moving.measure_moved(shown, back, SilentProgress::instance());
  }
  EXPECT_GT(far, 0u);
}

/// An interface that lies on that of the input has a distance of 0 before it moves away.
TEST(InterfaceComparison, BoundsOfZeroFollowMoves) {
  // Each triangle is much larger than the target, so that it is measured by itself.
  InterfaceMesh input = test::mesh_with_materials(2);
  input.points = {{0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5}, {1, 1, 0.5}};
  input.triangles = {{{0, 1, 2}, MaterialId(0), MaterialId(1)}, {{1, 3, 2}, MaterialId(0), MaterialId(1)}};
  InterfaceMesh shown = input;
  InterfaceComparison comparison(input, test::unit_box(), true, kTarget);
  comparison.measure(shown, SilentProgress::instance());
  EXPECT_TRUE(comparison.within());
  for (Vec3& p : shown.points) p.z += 2 * kTarget;
  comparison.measure_moved(shown, SilentProgress::instance());
  EXPECT_FALSE(comparison.within());
  for (std::uint32_t t = 0; t < input.triangles.size(); ++t) EXPECT_TRUE(comparison.too_far(t, 0)) << t;
}

TEST(InterfaceComparison, AMeshWithoutInterfacesIsInfinitelyFar) {
  for (const bool finely : {false, true}) {
    InterfaceMesh input = two_balls(0);
    if (!finely) input.triangles.resize(8);
    InterfaceComparison comparison(input, test::unit_box(), true, kTarget);
    comparison.measure(test::mesh_with_materials(3), SilentProgress::instance());
    EXPECT_FALSE(comparison.within());
    const InterfaceCertificate certificate = comparison.finish(SilentProgress::instance());
    EXPECT_EQ(certificate.networks.upper, std::numeric_limits<double>::infinity());
    EXPECT_EQ(certificate.materials.upper, std::numeric_limits<double>::infinity());
  }
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
    EXPECT_TRUE(changing.knows_each());
    changing.measure(shown, SilentProgress::instance(), false);
    EXPECT_FALSE(changing.knows_each());
    move_points(shown, 20, kTarget, random);
    changing.measure(shown, SilentProgress::instance());
    InterfaceComparison fresh(input, test::unit_box(), true, kTarget);
    fresh.measure(shown, SilentProgress::instance());
    expect_equal_measurements(changing, fresh, input.triangles.size());
  }
}

}  // namespace
}  // namespace adamas::interfaces
