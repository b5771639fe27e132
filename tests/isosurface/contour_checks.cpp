#include "tests/isosurface/contour_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace adamas::test {

using namespace isosurface;

Domain unit_domain(std::array<int, 3> roots) { return {{{0, 0, 0}, {1, 1, 1}}, roots}; }

std::vector<LatticePoint> refine(IndexedHierarchy& hierarchy, int generations) {
  std::vector<LatticePoint> done;
  for (int generation = 0; generation < generations; ++generation) {
    std::vector<LatticePoint> points;
    hierarchy.for_each_diamond([&](const Diamond& d, std::uint8_t) { points.push_back(d.point()); });
    for (const LatticePoint p : points) hierarchy.split(p, done);
  }
  return done;
}

void refine_randomly(IndexedHierarchy& hierarchy, unsigned seed, int steps) {
  std::mt19937 random(seed);
  std::vector<LatticePoint> points, done;
  hierarchy.for_each_diamond([&](const Diamond& d, std::uint8_t) { points.push_back(d.point()); });
  std::sort(points.begin(), points.end());
  for (int step = 0; step < steps; ++step) {
    done.clear();
    hierarchy.split(points[random() % points.size()], done);
    for (const LatticePoint p : done) {
      for (const LatticePoint child : Diamond(p).children(hierarchy.domain())) points.push_back(child);
    }
  }
}

double random_value(LatticePoint p, unsigned seed) {
  return std::ldexp(static_cast<double>(hash_value(p + LatticePoint{static_cast<std::int32_t>(seed), 0, 0})),
                    -64);
}

std::vector<std::array<std::uint32_t, 2>> border_edges(const Contour& contour) {
  std::map<std::array<std::uint32_t, 2>, std::array<int, 2>> uses;
  for (const auto& triangle : contour.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangle[c], b = triangle[(c + 1) % 3];
      EXPECT_NE(a, b);
      ++uses[{std::min(a, b), std::max(a, b)}][a < b ? 0 : 1];
    }
  }
  std::vector<std::array<std::uint32_t, 2>> border;
  int faults = 0;
  for (const auto& [edge, directions] : uses) {
    if (directions[0] + directions[1] == 1) {
      border.push_back(edge);
    } else if (directions != std::array{1, 1}) {
      ++faults;
    }
  }
  EXPECT_EQ(faults, 0);
  return border;
}

std::vector<int> topology(const Contour& contour) {
  // The triangles of each fan are followed one after another along the edges that begin at its point.
  std::vector<std::map<std::uint32_t, std::uint32_t>> behind(contour.points.size());
  std::vector<std::uint32_t> part(contour.points.size());
  std::iota(part.begin(), part.end(), 0);
  const std::function<std::uint32_t(std::uint32_t)> first = [&](std::uint32_t p) {
    return part[p] == p ? p : part[p] = first(part[p]);
  };
  std::set<std::array<std::uint32_t, 2>> edges;
  for (const auto& t : contour.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t p = t[c], after = t[(c + 1) % 3], before = t[(c + 2) % 3];
      EXPECT_TRUE(behind[p].emplace(after, before).second) << "two triangles on one side of an edge";
      edges.insert({std::min(p, after), std::max(p, after)});
      part[first(p)] = first(after);
    }
  }
  int faults = 0;
  for (const auto& fan : behind) {
    std::set<std::uint32_t> ends;
    for (const auto& [after, before] : fan) ends.insert(before);
    // A fan begins where no triangle comes before; a closed fan begins anywhere.
    std::uint32_t at = fan.empty() ? 0 : fan.begin()->first;
    for (const auto& [after, before] : fan) at = ends.contains(after) ? at : after;
    std::size_t met = 0;
    for (auto next = fan.find(at); next != fan.end() && met < fan.size(); next = fan.find(next->second))
      ++met;
    faults += fan.empty() || met != fan.size() || (fan.size() < 3 && ends.contains(at)) ? 1 : 0;
  }
  EXPECT_EQ(faults, 0) << "points with several fans of triangles, or none";
  std::map<std::uint32_t, int> euler;
  for (std::uint32_t p = 0; p < part.size(); ++p) ++euler[first(p)];
  for (const auto& edge : edges) --euler[first(edge[0])];
  for (const auto& t : contour.triangles) ++euler[first(t[0])];
  std::vector<int> result;
  for (const auto& [of, number] : euler) result.push_back(number);
  std::sort(result.begin(), result.end());
  return result;
}

void expect_closed(const Contour& contour, const Box3& box) {
  EXPECT_EQ(contour.points.size(),
            contour.edge_points.size() + contour.vertex_points.size() + contour.mean_points.size());
  for (const Vec3& p : contour.points) ASSERT_TRUE(box.contains(p));
  for (const auto& [a, b] : border_edges(contour)) {
    const Vec3 &p = contour.points[a], &q = contour.points[b];
    bool in_side = false;
    for (int axis = 0; axis < 3; ++axis) {
      in_side |= p[axis] == q[axis] && (p[axis] == box.min[axis] || p[axis] == box.max[axis]);
    }
    ASSERT_TRUE(in_side) << p.x << ' ' << p.y << ' ' << p.z << " - " << q.x << ' ' << q.y << ' ' << q.z;
  }
}

void SurfaceMeasure::add(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = 0.5 * cross(b - a, c - a);
  area += norm(normal);
  vector += normal;
  volume += dot(a, normal) / 3;
}

SurfaceMeasure measure(const Contour& contour) {
  SurfaceMeasure sum;
  for (const auto& [a, b, c] : contour.triangles)
    sum.add(contour.points[a], contour.points[b], contour.points[c]);
  return sum;
}

void expect_near(const SurfaceMeasure& a, const SurfaceMeasure& b, double tolerance) {
  EXPECT_NEAR(a.area, b.area, tolerance);
  EXPECT_NEAR(a.volume, b.volume, tolerance);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a.vector[axis], b.vector[axis], tolerance);
}

std::vector<Vec3> zero_polygon(const std::array<Vec3, 4>& points, const std::array<double, 4>& values) {
  std::vector<Vec3> corners;
  Vec3 centre, descent;
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t w = 0; w < 4; ++w) {
      if (values[v] < 0 || values[w] > 0) continue;
      const double t = values[v] / (values[v] - values[w]);
      corners.push_back((1 - t) * points[v] + t * points[w]);
      centre += corners.back();
      descent += points[w] - points[v];
    }
  }
  if (corners.empty()) return corners;
  centre *= 1.0 / static_cast<double>(corners.size());
  // `descent` is on the negative side of the plane but need not be normal to it.
  Vec3 normal;
  for (std::size_t c = 1; c + 1 < corners.size(); ++c) {
    const Vec3 n = cross(corners[c] - corners[0], corners[c + 1] - corners[0]);
    if (squared_norm(n) > squared_norm(normal)) normal = n;
  }
  normal = normalized(dot(normal, descent) < 0 ? -normal : normal);
  const Vec3 u = normalized(corners[0] - centre), v = cross(normal, u);
  const auto angle = [&](const Vec3& p) { return std::atan2(dot(p - centre, v), dot(p - centre, u)); };
  std::sort(corners.begin(), corners.end(),
            [&](const Vec3& a, const Vec3& b) { return angle(a) < angle(b); });
  return corners;
}

double positive_volume(const std::array<Vec3, 4>& points, const std::array<double, 4>& values) {
  // The distribution function of a linear function over a simplex is a divided difference of (x)_+^3.
  double fraction = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    if (values[v] <= 0) continue;
    double term = values[v] * values[v] * values[v];
    for (std::size_t w = 0; w < 4; ++w) {
      if (w != v) term /= values[v] - values[w];
    }
    fraction += term;
  }
  return fraction * signed_volume(points[0], points[1], points[2], points[3]);
}

}  // namespace adamas::test
