#include "interfaces/simplification/triangle_contacts.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>

namespace adamas {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;
using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const PlacedTriangle*>;

Point at(const Vec3& p) { return {p.x, p.y, p.z}; }

/// Corners that two triangles share, and then the others of each.
struct Pairing {
  Pairing(const PlacedTriangle& a, const PlacedTriangle& b) {
    for (std::size_t i = 0; i < 3; ++i) {
      const bool common = std::find(b.points.begin(), b.points.end(), a.points[i]) != b.points.end();
      if (common) {
        shared[shared_count++] = at(a.corners[i]);
      } else {
        of_a[a_count++] = at(a.corners[i]);
      }
    }
    std::size_t b_count = 0;
    for (std::size_t i = 0; i < 3 && b_count < a_count; ++i) {
      if (std::find(a.points.begin(), a.points.end(), b.points[i]) == a.points.end())
        of_b[b_count++] = at(b.corners[i]);
    }
  }
  std::array<Point, 3> shared, of_a, of_b;
  std::size_t shared_count = 0, a_count = 0;
};

}  // namespace

bool in_contact(const PlacedTriangle& a, const PlacedTriangle& b) {
  const Triangle first(at(a.corners[0]), at(a.corners[1]), at(a.corners[2]));
  const Triangle second(at(b.corners[0]), at(b.corners[1]), at(b.corners[2]));
  if (first.is_degenerate() || second.is_degenerate()) return false;
  const Pairing pair(a, b);
  const auto& s = pair.shared;
  switch (pair.shared_count) {
    case 0:
      return CGAL::do_intersect(first, second);
    case 1:
      // What they have in common beside the corner reaches the opposite edge of one of them.
      return CGAL::do_intersect(first, Segment(pair.of_b[0], pair.of_b[1])) ||
             CGAL::do_intersect(second, Segment(pair.of_a[0], pair.of_a[1]));
    case 2:
      return CGAL::coplanar(s[0], s[1], pair.of_a[0], pair.of_b[0]) &&
             CGAL::coplanar_orientation(s[0], s[1], pair.of_a[0], pair.of_b[0]) == CGAL::POSITIVE;
    default:
      return true;
  }
}

bool holds(const std::array<Vec3, 4>& tetrahedron, const Vec3& p) {
  const auto orientation = [&](std::size_t replaced) {
    std::array<Vec3, 4> c = tetrahedron;
    if (replaced < 4) c[replaced] = p;
    return CGAL::orientation(at(c[0]), at(c[1]), at(c[2]), at(c[3]));
  };
  const auto whole = orientation(4);
  if (whole == CGAL::ZERO) return false;
  for (std::size_t i = 0; i < 4; ++i) {
    if (orientation(i) == -whole) return false;
  }
  return true;
}

std::vector<std::array<std::uint32_t, 2>> find_contacts(const InterfaceMesh& mesh) {
  std::vector<PlacedTriangle> placed;
  placed.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) {
    const auto& p = t.points;
    placed.push_back({p, {mesh.points[p[0]], mesh.points[p[1]], mesh.points[p[2]]}});
  }
  std::vector<Box> boxes;
  boxes.reserve(placed.size());
  for (const PlacedTriangle& t : placed)
    boxes.emplace_back(at(t.corners[0]).bbox() + at(t.corners[1]).bbox() + at(t.corners[2]).bbox(), &t);
  std::vector<std::array<std::uint32_t, 2>> pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& x, const Box& y) {
    if (!in_contact(*x.handle(), *y.handle())) return;
    const auto i = static_cast<std::uint32_t>(x.handle() - placed.data());
    const auto j = static_cast<std::uint32_t>(y.handle() - placed.data());
    pairs.push_back({std::min(i, j), std::max(i, j)});
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace adamas
