#include "tests/support/closed_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace adamas::test {

namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

bool on_one_side(const Box3& box, const Vec3& a, const Vec3& b, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {box.min[axis], box.max[axis]}) {
      if (std::abs(a[axis] - side) <= tolerance && std::abs(b[axis] - side) <= tolerance) return true;
    }
  }
  return false;
}

/// The triangles that meet at an edge.
struct Star {
  std::vector<std::size_t> triangles;
  std::map<std::uint32_t, int> balance;  ///< by region: passes along the edge minus passes against it
};

/// Returns whether, in the order of angles round an edge, the region behind each triangle is the one in front
/// of the next. This holds where a region comes to the edge from two sides.
bool is_fan(const std::vector<Vec3>& points, const std::vector<SidedTriangle>& triangles, const Edge& edge,
            const Star& star) {
  struct Sheet {
    double angle;
    std::uint32_t after, before;  ///< regions at greater and at smaller angles
  };
  const Vec3 a = points[edge.first], axis = normalized(points[edge.second] - a);
  Vec3 u, v;
  std::vector<Sheet> sheets;
  for (const std::size_t t : star.triangles) {
    const SidedTriangle& triangle = triangles[t];
    std::size_t c = 0;
    while (triangle.points[c] == edge.first || triangle.points[c] == edge.second) ++c;
    Vec3 offset = points[triangle.points[c]] - a;
    offset -= dot(offset, axis) * axis;
    if (sheets.empty()) u = normalized(offset), v = cross(axis, u);
    // Where the triangle runs along the edge upwards, its normal, towards the front, points to greater
    // angles.
    const bool upwards = triangle.points[(c + 1) % 3] == edge.first;
    sheets.push_back({std::atan2(dot(offset, v), dot(offset, u)), upwards ? triangle.front : triangle.back,
                      upwards ? triangle.back : triangle.front});
  }
  std::sort(sheets.begin(), sheets.end(), [](const Sheet& x, const Sheet& y) { return x.angle < y.angle; });
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    if (sheets[i].after != sheets[(i + 1) % sheets.size()].before) return false;
  }
  return true;
}

/// Returns how often the boundary of a region, seen from outside, runs from the first point of an edge to the
/// second, less how often it runs back.
using Chain = std::map<Edge, int>;

Chain boundary_of(const std::vector<SidedTriangle>& triangles, std::uint32_t region) {
  Chain chain;
  const auto add = [&](std::uint32_t a, std::uint32_t b, int times) {
    chain[std::minmax(a, b)] += a < b ? times : -times;
  };
  for (const SidedTriangle& t : triangles) {
    const int times = (t.back == region ? 1 : 0) - (t.front == region ? 1 : 0);
    if (times == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) add(t.points[c], t.points[(c + 1) % 3], times);
  }
  return chain;
}

}  // namespace

std::vector<SidedTriangle> sided_by_material(const InterfaceMesh& mesh) {
  std::vector<SidedTriangle> result;
  for (const InterfaceTriangle& t : mesh.triangles) result.push_back({t.points, t.front.value, t.back.value});
  return result;
}

EdgeReport check_edges(const std::vector<Vec3>& points, const std::vector<SidedTriangle>& triangles,
                       const Box3& box, double tolerance) {
  EdgeReport report;
  std::map<Edge, Star> stars;
  for (const SidedTriangle& t : triangles) {
    const auto& p = t.points;
    if (t.front == t.back || p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) ++report.degenerate;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = p[c], b = p[(c + 1) % 3];
      Star& star = stars[std::minmax(a, b)];
      star.triangles.push_back(static_cast<std::size_t>(&t - triangles.data()));
      star.balance[t.back] += a < b ? 1 : -1;
      star.balance[t.front] -= a < b ? 1 : -1;
    }
  }
  for (const auto& [edge, star] : stars) {
    const Vec3 &a = points[edge.first], &b = points[edge.second];
    if (on_one_side(box, a, b, tolerance)) continue;
    ++report.inner_edges;
    const bool open = std::any_of(star.balance.begin(), star.balance.end(),
                                  [](const auto& entry) { return entry.second != 0; });
    if (open) ++report.open;
    const std::size_t count = star.triangles.size(), met = star.balance.size();
    if (count < 2) ++report.lonely;
    if (count != std::max<std::size_t>(met, 2) && !is_fan(points, triangles, edge, star)) ++report.uneven;
    if ((open || count < 2) && report.first.empty()) {
      report.first = fmt::format("({}, {}, {}) - ({}, {}, {}), {} triangles, {} regions", a.x, a.y, a.z, b.x,
                                 b.y, b.z, count, met);
    }
  }
  return report;
}

std::vector<double> enclosed_volumes(const std::vector<Vec3>& points,
                                     const std::vector<SidedTriangle>& triangles, std::size_t regions,
                                     const Box3& box, std::uint32_t corner, double tolerance) {
  const Vec3 size = box.size();
  std::vector<double> volumes(regions, 0.0);
  for (const SidedTriangle& t : triangles) {
    const Vec3 &a = points[t.points[0]], &b = points[t.points[1]], &c = points[t.points[2]];
    const double flux = ((a.x + b.x + c.x) / 3 - box.min.x) * 0.5 * cross(b - a, c - a).x;
    volumes[t.back] += flux;
    volumes[t.front] -= flux;
  }
  const auto near = [&](double x, double side) { return std::abs(x - side) <= tolerance; };
  for (std::uint32_t region = 0; region < regions; ++region) {
    double area = 0, length = region == corner ? size.z : 0;
    for (const auto& [edge, times] : boundary_of(triangles, region)) {
      const Vec3 &a = points[edge.first], &b = points[edge.second];
      if (times == 0 || !near(a.x, box.max.x) || !near(b.x, box.max.x)) continue;
      // The region's part of the face has the opposite direction to the boundary of its interfaces.
      area -= times * (0.5 * (a.y + b.y) - box.min.y) * (b.z - a.z);
      // The boundary of that part runs up along y = max.y from the end of one chain to the start of the next.
      if (near(a.y, box.max.y)) length -= times * (a.z - box.min.z);
      if (near(b.y, box.max.y)) length += times * (b.z - box.min.z);
    }
    volumes[region] += size.x * (area + size.y * length);
  }
  return volumes;
}

}  // namespace adamas::test
