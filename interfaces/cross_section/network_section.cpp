#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>

#include "interfaces/cross_section/cross_section.h"
#include "interfaces/network/network_mesh.h"

namespace adamas {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Structure = CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_2<Kernel>,
                                                       CGAL::Constrained_triangulation_face_base_2<Kernel>>;
/// Interfaces may cross each other, where that was allowed, and the sides of the box.
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::Exact_predicates_tag>;

/// A convex polygon, in either direction.
bool contains(const std::vector<Kernel::Point_2>& polygon, const Kernel::Point_2& p) {
  bool left = false, right = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const auto side = CGAL::orientation(polygon[i], polygon[(i + 1) % polygon.size()], p);
    left = left || side == CGAL::LEFT_TURN;
    right = right || side == CGAL::RIGHT_TURN;
  }
  return !(left && right);
}

}  // namespace

CrossSection cross_section(const InterfaceNetwork& network, const Box3& box, std::size_t materials,
                           const Plane& plane, const std::string& source) {
  const PlaneSides sides(plane, box, source);
  const PlaneFrame frame = plane_frame(plane);
  const auto flat = [&](const Vec3& p) {
    const auto [x, y] = frame.coordinates(p);
    return Kernel::Point_2(x, y);
  };
  std::vector<Kernel::Point_2> outline;
  for (const Vec3& p : clip_plane(plane, box)) outline.push_back(flat(p));
  Triangulation triangulation;
  for (std::size_t i = 0; i < outline.size(); ++i)
    triangulation.insert_constraint(outline[i], outline[(i + 1) % outline.size()]);
  for (const Segment& s : section_edges(network_mesh(network, {}, source), plane, box))
    triangulation.insert_constraint(flat(s[0]), flat(s[1]));

  // The frame's origin lies on the plane's normal, but not in the plane where that is at right angles to an
  // axis.
  const Vec3& normal = sides.normal();
  const Vec3 base = frame.origin + dot(normal, plane.origin - frame.origin) * normal;
  const bool mirrored = dot(cross(frame.right, frame.up), plane.normal) < 0;
  CrossSection section;
  section.material_area.assign(materials, 0);
  for (const auto face : triangulation.finite_face_handles()) {
    if (!contains(outline, CGAL::centroid(triangulation.triangle(face)))) continue;
    SectionPiece piece;
    for (int i = 0; i < 3; ++i) {
      const auto& p = face->vertex(i)->point();
      piece.corners.push_back(base + p.x() * frame.right + p.y() * frame.up);
    }
    if (mirrored) std::swap(piece.corners[1], piece.corners[2]);
    const Vec3 middle = (1.0 / 3) * (piece.corners[0] + piece.corners[1] + piece.corners[2]);
    piece.body = network.body_at(middle + sides.nudge());
    piece.material = network.table().material(piece.body);
    const double area = polygon_area(piece.corners);
    section.area += area;
    section.material_area[piece.material] += area;
    section.pieces.push_back(std::move(piece));
  }
  return section;
}

}  // namespace adamas
