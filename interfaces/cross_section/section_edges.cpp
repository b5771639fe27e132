#include "interfaces/cross_section/section_edges.h"

#include <algorithm>
#include <tuple>

namespace adamas::interfaces {

namespace {

bool comes_before(const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

}  // namespace

Segment directed(const Segment& segment) {
  return comes_before(segment[1], segment[0]) ? Segment{segment[1], segment[0]} : segment;
}

bool comes_before(const Segment& a, const Segment& b) {
  return a[0] == b[0] ? comes_before(a[1], b[1]) : comes_before(a[0], b[0]);
}

void make_unique(std::vector<Segment>& segments) {
  std::erase_if(segments, [](const Segment& s) { return s[0] == s[1]; });
  for (Segment& s : segments) s = directed(s);
  std::sort(segments.begin(), segments.end(),
            [](const Segment& a, const Segment& b) { return comes_before(a, b); });
  segments.erase(std::unique(segments.begin(), segments.end()), segments.end());
}

std::vector<Segment> section_edges(const InterfaceMesh& mesh, const Plane& plane, const Box3& box) {
  const PlaneSides sides(plane, box, mesh.source);
  std::vector<double> distances(mesh.points.size());
  for (std::size_t i = 0; i < distances.size(); ++i) distances[i] = sides.distance(mesh.points[i]);
  std::vector<Segment> segments;
  for (const InterfaceTriangle& t : mesh.triangles) {
    Segment segment;
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      // The same order of the ends in every triangle, so that the points are the same to the bit.
      const auto [a, b] = std::minmax(t.points[i], t.points[(i + 1) % 3]);
      if (sides.above(distances[a]) == sides.above(distances[b])) continue;
      segment[found++] = PlaneSides::crossing(mesh.points[a], distances[a], mesh.points[b], distances[b]);
    }
    if (found == 2) segments.push_back(segment);
  }
  make_unique(segments);
  return segments;
}

}  // namespace adamas::interfaces
