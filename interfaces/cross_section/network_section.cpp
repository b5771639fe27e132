#include <algorithm>
#include <cmath>
#include <span>

#include "interfaces/cross_section/cross_section.h"
#include "interfaces/cross_section/trapezoidal_decomposition.h"
#include "interfaces/network/box_tree.h"
#include "interfaces/network/network_mesh.h"

namespace adamas::interfaces {

namespace {

double cross(const PlanePoint& a, const PlanePoint& b) { return a[0] * b[1] - a[1] * b[0]; }
PlanePoint operator-(const PlanePoint& a, const PlanePoint& b) { return {a[0] - b[0], a[1] - b[1]}; }
PlanePoint at(const PlanePoint& p, double t, const PlanePoint& way) {
  return {p[0] + t * way[0], p[1] + t * way[1]};
}

/// Whether a convex polygon, whichever way it runs, contains a point.
bool contains(const std::vector<PlanePoint>& polygon, const PlanePoint& p) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const double turn = cross(polygon[(i + 1) % polygon.size()] - polygon[i], p - polygon[i]);
    left = left || turn > 0;
    right = right || turn < 0;
  }
  return !(left && right);
}

/// Lines of a section, for the first one that a ray meets.
class LineTree {
 public:
  explicit LineTree(std::span<const PlaneSegment> lines) : lines_(lines) {
    std::vector<Box3> boxes;
    for (const PlaneSegment& line : lines) {
      boxes.push_back(box_of(line));
      for (const PlanePoint& p : line) bounds_.extend({p[0], p[1], 0});
    }
    tree_ = BoxTree(boxes);
  }
  /// Greater than the distance of any two points.
  [[nodiscard]] double size() const { return 2 * bounds_.diagonal(); }
  /// How far a ray of unit direction goes from the end of a line until it meets another line, within a
  /// tolerance.
  [[nodiscard]] double way(std::uint32_t from, const PlanePoint& p, const PlanePoint& direction,
                           double tolerance) const {
    double nearest = size();
    tree_.for_each_touching(
        box_of({at(p, -tolerance, direction), at(p, nearest, direction)}), [&](std::uint32_t i) {
          const auto& [a, b] = lines_[i];
          const PlanePoint along = b - a;
          const double length = std::hypot(along[0], along[1]), turn = cross(direction, along);
          if (i == from || std::abs(turn) <= 1e-12 * length) return true;
          const double t = cross(a - p, along) / turn, u = cross(a - p, direction) / turn * length;
          if (t >= -tolerance && u >= -tolerance && u <= length + tolerance) nearest = std::min(nearest, t);
          return true;
        });
    return nearest;
  }

 private:
  static Box3 box_of(const PlaneSegment& line) {
    Box3 box;
    for (const PlanePoint& p : line) box.extend({p[0], p[1], 0});
    return box;
  }
  std::span<const PlaneSegment> lines_;
  Box3 bounds_;
  BoxTree tree_;
};

/// Lets lines that end inside of the outline go on straight to the next line: bodies go on there as if their
/// interfaces did, so that the parts between the lines are of one body each.
void continue_open_ends(const std::vector<PlanePoint>& outline, std::vector<PlaneSegment>& lines) {
  std::vector<std::pair<PlanePoint, std::uint32_t>> ends;
  for (std::uint32_t i = 0; i < lines.size(); ++i) {
    for (const PlanePoint& p : lines[i]) ends.emplace_back(p, i);
  }
  std::sort(ends.begin(), ends.end());
  const LineTree tree(lines);
  const double tolerance = 1e-9 * tree.size();
  std::vector<PlaneSegment> added;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const auto& [p, line] = ends[i];
    const bool shared = (i > 0 && ends[i - 1].first == p) || (i + 1 < ends.size() && ends[i + 1].first == p);
    if (shared || !contains(outline, p)) continue;
    const PlanePoint along = p - lines[line][lines[line][0] == p ? 1 : 0];
    const double length = std::hypot(along[0], along[1]);
    const PlanePoint direction{along[0] / length, along[1] / length};
    const double way = tree.way(line, p, direction, tolerance);
    if (way > tolerance) added.push_back({p, at(p, way + tolerance, direction)});
  }
  lines.insert(lines.end(), added.begin(), added.end());
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
  continue_open_ends(outline, lines);

  // Where the plane is at right angles to an axis, the frame's origin lies on its normal but not in it.
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

}  // namespace adamas::interfaces
