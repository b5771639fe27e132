#include "interfaces/cell_errors/hull_distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

namespace adamas {

using namespace interfaces;

namespace {

using Point = std::vector<double>;

double product(const Point& a, const Point& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Solves a small system by Gaussian elimination; none where it is (nearly) singular.
std::optional<Point> solve(std::vector<Point> rows, Point right) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i) {
      if (std::abs(rows[i][k]) > std::abs(rows[pivot][k])) pivot = i;
    }
    if (std::abs(rows[pivot][k]) < 1e-9) return {};
    std::swap(rows[k], rows[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = rows[i][k] / rows[k][k];
      for (std::size_t j = k; j < n; ++j) rows[i][j] -= factor * rows[k][j];
      right[i] -= factor * right[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) right[k] /= rows[k][k];
  return right;
}

/// Returns the distance of the origin from the affine hull of some points, where its nearest point is in
/// their convex hull.
std::optional<double> distance_from_simplex(const std::vector<Point>& points) {
  std::vector<Point> edges(points.begin() + 1, points.end());
  for (Point& edge : edges) {
    for (std::size_t c = 0; c < edge.size(); ++c) edge[c] -= points[0][c];
  }
  std::vector<Point> rows;
  Point right;
  for (const Point& edge : edges) {
    rows.emplace_back();
    for (const Point& other : edges) rows.back().push_back(product(edge, other));
    right.push_back(-product(edge, points[0]));
  }
  const auto t = solve(rows, right);
  if (!t || std::any_of(t->begin(), t->end(), [](double x) { return x < 0; })) return {};
  if (std::accumulate(t->begin(), t->end(), 0.0) > 1) return {};
  Point nearest = points[0];
  for (std::size_t e = 0; e < edges.size(); ++e) {
    for (std::size_t c = 0; c < nearest.size(); ++c) nearest[c] += (*t)[e] * edges[e][c];
  }
  return std::sqrt(product(nearest, nearest));
}

/// Returns the distance of the hull from the origin by brute force over all subsets of affinely independent
/// points.
double brute_distance(const std::vector<double>& points, std::size_t dimension) {
  const std::size_t count = points.size() / dimension;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t subset = 1; subset < std::size_t{1} << count; ++subset) {
    std::vector<Point> members;
    for (std::size_t i = 0; i < count; ++i) {
      const auto first = points.begin() + static_cast<std::ptrdiff_t>(i * dimension);
      if ((subset >> i & 1u) != 0)
        members.emplace_back(first, first + static_cast<std::ptrdiff_t>(dimension));
    }
    if (members.size() > dimension + 1) continue;
    least = std::min(least, distance_from_simplex(members).value_or(least));
  }
  return least;
}

TEST(HullDistance, IsThatOfAllSubsets) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::size_t inside = 0;
  for (int i = 0; i < 400; ++i) {
    const std::size_t dimension = 1 + random() % 4, count = 1 + random() % 8;
    std::vector<double> points(dimension * count);
    const double shift = 0.3 * static_cast<double>(random() % 4);
    // Every third set lies on a lattice, so that points coincide and affine hulls are degenerate.
    for (double& x : points) {
      x = coordinate(random) + shift;
      if (i % 3 == 0) x = std::round(2 * x) / 2;
    }
    const double brute = brute_distance(points, dimension);
    inside += brute < 1e-9 ? 1 : 0;
    ASSERT_NEAR(distance_from_hull(points, dimension), brute, 1e-6) << i;
    ASSERT_GE(distance_from_hull(points, dimension), brute - 1e-9) << i;
  }
  EXPECT_GT(inside, 20u);
  EXPECT_LT(inside, 380u);
}

TEST(HullDistance, OfNoPointsIsInfinite) {
  EXPECT_EQ(distance_from_hull({}, 3), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace adamas
