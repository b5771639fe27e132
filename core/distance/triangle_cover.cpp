#include "core/distance/triangle_cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace adamas::inline core {

namespace {

using Polygon = std::vector<Vec3>;

constexpr int kMostParts = 24;

Vec3 middle(const Polygon& polygon) {
  Vec3 sum;
  for (const Vec3& p : polygon) sum += p;
  return 1 / static_cast<double>(polygon.size()) * sum;
}

/// The greatest distance of a polygon from one triangle, which is at a corner since the distance is convex.
double greatest_distance(const Polygon& polygon, const std::array<Vec3, 3>& triangle) {
  double greatest = 0;
  for (const Vec3& p : polygon)
    greatest = std::max(greatest, closest_on_triangle(p, triangle).squared_distance);
  return std::sqrt(greatest);
}

/// Clips a convex polygon to the part where dot(normal, p - origin) <= 0, and returns the rest.
Polygon cut(Polygon& polygon, const Vec3& origin, const Vec3& normal) {
  Polygon kept, rest;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double x = dot(normal, a - origin), y = dot(normal, b - origin);
    if (x <= 0) kept.push_back(a);
    if (x >= 0) rest.push_back(a);
    if ((x < 0 && y > 0) || (x > 0 && y < 0)) {
      const Vec3 p = a + (x / (x - y)) * (b - a);
      kept.push_back(p);
      rest.push_back(p);
    }
  }
  polygon.swap(kept);
  return rest;
}

/// Clips the polygon to what lies above or below the triangle, and appends the rest, in convex parts, to
/// `parts`.
void cut_along_edges(Polygon& polygon, const std::array<Vec3, 3>& triangle, std::vector<Polygon>& parts) {
  const Vec3 normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& a = triangle[i];
    Polygon rest = cut(polygon, a, cross(triangle[(i + 1) % 3] - a, normal));
    if (rest.size() >= 3) parts.push_back(std::move(rest));
  }
}

}  // namespace

double covered_distance(std::span<const Vec3> polygon, const ClosestPointTree& to, double enough) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<Polygon> parts{Polygon(polygon.begin(), polygon.end())};
  double greatest = 0;
  for (int looked_at = 0; !parts.empty(); ++looked_at) {
    if (looked_at == kMostParts) return kInfinity;
    Polygon part = std::move(parts.back());
    parts.pop_back();
    const auto closest = to.closest(middle(part));
    if (!closest || !(closest->squared_distance <= enough * enough)) return kInfinity;
    const std::array<Vec3, 3>& triangle = to.triangle(closest->triangle);
    double distance = greatest_distance(part, triangle);
    if (distance > enough) {
      const std::size_t before = parts.size();
      cut_along_edges(part, triangle, parts);
      if (parts.size() == before) return kInfinity;
      distance = greatest_distance(part, triangle);
      if (distance > enough) return kInfinity;
    }
    greatest = std::max(greatest, distance);
  }
  return greatest;
}

}  // namespace adamas::inline core
