#include "interfaces/cross_section/trapezoidal_decomposition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace adamas {

using namespace interfaces;

namespace {

using Polygon = std::vector<PlanePoint>;

double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) twice += turn(polygon[0], polygon[i - 1], polygon[i]);
  return 0.5 * twice;
}

PlanePoint middle(const Polygon& polygon) {
  PlanePoint sum{};
  for (const PlanePoint& p : polygon) sum = {sum[0] + p[0], sum[1] + p[1]};
  const auto count = static_cast<double>(polygon.size());
  return {sum[0] / count, sum[1] / count};
}

/// Returns whether a convex polygon that runs counter-clockwise contains a point.
bool contains(const Polygon& polygon, const PlanePoint& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (turn(polygon[i], polygon[(i + 1) % polygon.size()], p) < 0) return false;
  }
  return true;
}

/// Returns whether a part of a segment lies well inside a convex polygon.
bool passes_through(const PlaneSegment& segment, const Polygon& polygon) {
  double from = 0, to = 1;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlanePoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double margin = 1e-9 * std::hypot(q[0] - p[0], q[1] - p[1]);
    const double first = turn(p, q, segment[0]) - margin, second = turn(p, q, segment[1]) - margin;
    if (first <= 0 && second <= 0) return false;
    if (first < 0) from = std::max(from, first / (first - second));
    if (second < 0) to = std::min(to, first / (first - second));
  }
  return from < to;
}

void append_sides(const Polygon& polygon, std::vector<PlaneSegment>& segments) {
  for (std::size_t i = 0; i < polygon.size(); ++i)
    segments.push_back({polygon[i], polygon[(i + 1) % polygon.size()]});
}

/// Expects that, whatever other segments there are, the parts in a polygon fill it and no segment passes
/// through a part.
void check(const std::vector<Polygon>& polygons, const std::vector<PlaneSegment>& others) {
  std::vector<PlaneSegment> segments = others;
  for (const Polygon& polygon : polygons) append_sides(polygon, segments);
  const std::vector<Trapezoid> parts = trapezoidal_decomposition(segments);
  std::vector<double> areas(polygons.size(), 0);
  for (const Trapezoid& part : parts) {
    const Polygon& corners = part.corners;
    ASSERT_TRUE(corners.size() == 3 || corners.size() == 4);
    ASSERT_GE(area(corners), 0);
    const PlanePoint inside = middle(corners);
    for (std::size_t i = 0; i < polygons.size(); ++i) {
      if (contains(polygons[i], inside)) areas[i] += area(corners);
    }
    for (const PlaneSegment& segment : segments)
      ASSERT_TRUE(segment[0] == segment[1] || !passes_through(segment, corners));
  }
  for (std::size_t i = 0; i < polygons.size(); ++i)
    EXPECT_NEAR(areas[i], area(polygons[i]), 1e-9 * (1 + area(polygons[i])));
}

/// Segments between random points, in general position or on a lattice. On a lattice many of them touch,
/// overlap, or meet in one point.
class RandomSegments {
 public:
  RandomSegments(std::uint64_t seed, int lattice) : random_(seed), lattice_(lattice) {}
  PlanePoint point() {
    if (lattice_ > 0) {
      std::uniform_int_distribution<int> number(0, lattice_);
      const int x = number(random_), y = number(random_);
      return {1.0 * x, 1.0 * y};
    }
    std::uniform_real_distribution<double> number(0, 1);
    const double x = number(random_), y = number(random_);
    return {x, y};
  }
  Polygon triangle() {
    Polygon corners{point(), point(), point()};
    if (area(corners) < 0) std::swap(corners[1], corners[2]);
    return corners;
  }
  PlaneSegment segment() {
    const PlanePoint a = point(), b = point();
    return {a, b};
  }

 private:
  std::mt19937_64 random_;
  int lattice_;
};

TEST(TrapezoidalDecomposition, PartsFillPolygonsThatOverlap) {
  for (const int lattice : {0, 3, 5, 9}) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      RandomSegments random(seed, lattice);
      const double side = lattice > 0 ? lattice : 1;
      std::vector<Polygon> polygons{{{0, 0}, {side, 0}, {side, side}, {0, side}}};
      for (int i = 0; i < 6; ++i) polygons.push_back(random.triangle());
      std::erase_if(polygons, [](const Polygon& p) { return area(p) == 0; });
      std::vector<PlaneSegment> others;
      for (std::uint64_t i = 0; i < seed % 20; ++i) others.push_back(random.segment());
      check(polygons, others);
    }
  }
}

TEST(TrapezoidalDecomposition, NothingIsBetweenSegmentsInARow) {
  EXPECT_TRUE(trapezoidal_decomposition({}).empty());
  const std::vector<PlaneSegment> open{
      {{{0, 0}, {1, 1}}}, {{{1, 1}, {2, 0}}}, {{{2, 0}, {2, 5}}}, {{{3, 3}, {3, 3}}}};
  double sum = 0;
  for (const Trapezoid& part : trapezoidal_decomposition(open)) sum += area(part.corners);
  EXPECT_EQ(sum, 0);
}

/// The lines cross in one point, rounded or not, and overlap in parts.
TEST(TrapezoidalDecomposition, StarsOfLines) {
  for (const int count : {2, 3, 7, 30}) {
    std::vector<PlaneSegment> lines;
    const Polygon square{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int i = 0; i < count; ++i) {
      const double angle = M_PI * i / count, x = std::cos(angle), y = std::sin(angle);
      lines.push_back({{{-x, -y}, {x, y}}});
      lines.push_back({{{-0.5 * x, -0.5 * y}, {2 * x, 2 * y}}});
    }
    check({square}, lines);
  }
}

/// There are long thin parts next to each other, far smaller than the round-off of the crossings.
TEST(TrapezoidalDecomposition, AlmostParallelLines) {
  std::vector<PlaneSegment> lines;
  for (int i = 0; i < 20; ++i) {
    const double e = 1e-16 * i;
    lines.push_back({{{0, 0.5 + e}, {1, 0.5 - e}}});
    lines.push_back({{{0.25 + e, 0}, {0.25 - e, 1}}});
  }
  check({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, lines);
}

}  // namespace
}  // namespace adamas
