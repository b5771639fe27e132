#include <algorithm>

#include "interfaces/cross_section/cross_section.h"
#include "interfaces/cross_section/trapezoidal_decomposition.h"
#include "interfaces/network/network_mesh.h"

namespace adamas {

namespace {

/// Of a convex polygon, in either direction.
bool contains(const std::vector<PlanePoint>& polygon, const PlanePoint& p) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const PlanePoint &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double turn = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return !(left && right);
}

}  // namespace

CrossSection cross_section(const InterfaceNetwork& network, const Box3& box, std::size_t materials,
                           const Plane& plane, const std::string& source) {
  const PlaneSides sides(plane, box, source);
  const PlaneFrame frame = plane_frame(plane);
  // Interfaces may cross each other, where that was allowed, and the sides of the box.
  std::vector<PlanePoint> outline;
  for (const Vec3& p : clip_plane(plane, box)) outline.push_back(frame.coordinates(p));
  std::vector<PlaneSegment> lines;
  for (std::size_t i = 0; i < outline.size(); ++i)
    lines.push_back({outline[i], outline[(i + 1) % outline.size()]});
  for (const Segment& s : section_edges(network_mesh(network, {}, source), plane, box))
    lines.push_back({frame.coordinates(s[0]), frame.coordinates(s[1])});

  // The frame's origin lies on the plane's normal, but not in the plane where that is at right angles to an
  // axis.
  const Vec3& normal = sides.normal();
  const Vec3 base = frame.origin + dot(normal, plane.origin - frame.origin) * normal;
  const bool mirrored = dot(cross(frame.right, frame.up), plane.normal) < 0;
  CrossSection section;
  section.material_area.assign(materials, 0);
  for (const Trapezoid& part : trapezoidal_decomposition(lines)) {
    const PlanePoint middle = part.middle();
    if (!contains(outline, middle)) continue;
    const auto place = [&](const PlanePoint& p) { return base + p[0] * frame.right + p[1] * frame.up; };
    SectionPiece piece;
    for (const PlanePoint& p : part.corners) piece.corners.push_back(place(p));
    if (mirrored) std::reverse(piece.corners.begin(), piece.corners.end());
    piece.body = network.body_at(place(middle) + sides.nudge());
    piece.material = network.table().material(piece.body);
    const double area = polygon_area(piece.corners);
    section.area += area;
    section.material_area[piece.material] += area;
    section.pieces.push_back(std::move(piece));
  }
  return section;
}

}  // namespace adamas
