#include <gtest/gtest.h>

#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "core/distance/closest_point_tree.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {
namespace {

/// Returns a tree of points, which are triangles without area.
ClosestPointTree tree_of(const std::vector<Vec3>& points) {
  test::Triangles triangles;
  for (std::uint32_t i = 0; i < points.size(); ++i) triangles.push_back({i, i, i});
  return {points, triangles};
}

struct NearestVertex {
  std::uint32_t index;
  double squared_distance;
};

/// Returns the nearest vertex after a look at every point in order.
std::optional<NearestVertex> by_brute_force(const std::vector<Vec3>& points, const Vec3& q, double reach) {
  std::optional<NearestVertex> best;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const double d = squared_norm(q - points[i]);
    if (d <= reach * reach && (!best || d < best->squared_distance)) best = {i, d};
  }
  return best;
}

void compare(const std::vector<Vec3>& points, const Vec3& q, double reach) {
  const auto expected = by_brute_force(points, q, reach);
  const auto found = tree_of(points).closest(q, reach);
  ASSERT_EQ(found.has_value(), expected.has_value());
  if (!found) return;
  EXPECT_EQ(found->triangle, expected->index);
  EXPECT_EQ(found->squared_distance, expected->squared_distance);
}

TEST(ClosestVertex, AgreesWithLookingAtAllPoints) {
  std::mt19937_64 random(1);
  for (const std::size_t count : {0u, 1u, 2u, 11u, 300u}) {
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < count; ++i) points.push_back(test::random_point(random, test::unit_box()));
    for (int i = 0; i < 50; ++i) {
      for (const double reach : {0.05, 0.3, std::numeric_limits<double>::infinity()})
        compare(points, test::random_point(random, test::unit_box()), reach);
    }
  }
}

/// The first one of equally near points counts.
TEST(ClosestVertex, TiesOnALattice) {
  std::vector<Vec3> points;
  for (int i = 0; i < 6 * 6 * 6; ++i)
    points.push_back({1.0 * (i * 5 % 6), 1.0 * (i / 6 % 6), 1.0 * (i / 36)});
  for (int i = 0; i < 11 * 11 * 11; ++i)
    compare(points, {0.5 * (i % 11), 0.5 * (i / 11 % 11), 0.5 * (i / 121)}, 1);
  std::vector<Vec3> sphere;
  for (const double s : {-1.0, 1.0}) sphere.insert(sphere.end(), {{s, 0, 0}, {0, s, 0}, {0, 0, s}});
  compare(sphere, {0, 0, 0}, 2);
}

TEST(ClosestVertex, NothingIsNearWhatIsNotFinite) {
  const ClosestPointTree tree = tree_of({{0, 0, 0}});
  EXPECT_FALSE(tree.closest({std::numeric_limits<double>::quiet_NaN(), 0, 0}, 1));
  EXPECT_FALSE(tree.closest({std::numeric_limits<double>::infinity(), 0, 0}, 1));
  EXPECT_TRUE(tree.closest({1, 0, 0}, 1));
}

}  // namespace
}  // namespace adamas
