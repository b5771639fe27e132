#include <cmath>

#include "core/io/polygon_soup.h"

namespace adamas::io {

namespace {

struct Point2 {
  double x = 0, y = 0;
};

double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Newell's normal: twice the vector area.
Vec3 vector_area(const std::vector<Vec3>& points, const std::uint32_t* corners, std::size_t count) {
  Vec3 area;
  const Vec3& origin = points[corners[0]];
  for (std::size_t i = 1; i + 1 < count; ++i) {
    area += cross(points[corners[i]] - origin, points[corners[i + 1]] - origin);
  }
  return area;
}

bool is_ear(const std::vector<Point2>& flat, const std::vector<std::size_t>& ring, std::size_t at) {
  const std::size_t n = ring.size();
  const std::size_t before = ring[(at + n - 1) % n], tip = ring[at], after = ring[(at + 1) % n];
  const Point2 &a = flat[before], &b = flat[tip], &c = flat[after];
  if (!(turn(a, b, c) > 0)) return false;
  for (const std::size_t i : ring) {
    if (i == before || i == tip || i == after) continue;
    const Point2& p = flat[i];
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(const std::vector<Vec3>& points,
                                                              const std::uint32_t* corners,
                                                              std::size_t count) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  if (count < 3) return triangles;
  if (count == 3) return {{corners[0], corners[1], corners[2]}};
  const Vec3 area = vector_area(points, corners, count);
  // Dropping the axis along which the normal is longest keeps the turn when the other two are cyclic.
  int drop = 0;
  for (int axis = 1; axis < 3; ++axis) {
    if (std::abs(area[axis]) > std::abs(area[drop])) drop = axis;
  }
  const int u = (drop + 1) % 3, v = (drop + 2) % 3;
  std::vector<Point2> flat;
  std::vector<std::size_t> ring;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3& p = points[corners[i]];
    flat.push_back(area[drop] >= 0 ? Point2{p[u], p[v]} : Point2{p[v], p[u]});
    ring.push_back(i);
  }
  while (ring.size() > 3) {
    const std::size_t n = ring.size();
    std::size_t at = 1;
    for (std::size_t i = 0; i < n; ++i) {
      if (is_ear(flat, ring, (i + 1) % n)) {
        at = (i + 1) % n;
        break;
      }
    }
    triangles.push_back({corners[ring[(at + n - 1) % n]], corners[ring[at]], corners[ring[(at + 1) % n]]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
  }
  triangles.push_back({corners[ring[0]], corners[ring[1]], corners[ring[2]]});
  return triangles;
}

}  // namespace adamas::io
