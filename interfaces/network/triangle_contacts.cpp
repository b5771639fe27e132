#include "interfaces/network/triangle_contacts.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <mutex>

#include "interfaces/network/box_tree.h"
#include "interfaces/network/edge_fans.h"

namespace adamas::interfaces {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Triangle = Kernel::Triangle_3;
using Segment = Kernel::Segment_3;
using Pair = std::array<std::uint32_t, 2>;

Point at(const Vec3& p) { return {p.x, p.y, p.z}; }

Triangle exact_triangle(const PlacedTriangle& t) {
  return {at(t.corners[0]), at(t.corners[1]), at(t.corners[2])};
}

bool share_point(const PlacedTriangle& a, const PlacedTriangle& b) {
  return std::any_of(a.points.begin(), a.points.end(), [&b](std::uint32_t p) {
    return p == b.points[0] || p == b.points[1] || p == b.points[2];
  });
}

std::vector<PlacedTriangle> placed_triangles(const InterfaceMesh& mesh) {
  std::vector<PlacedTriangle> placed;
  placed.reserve(mesh.triangles.size());
  for (const InterfaceTriangle& t : mesh.triangles) {
    const auto& p = t.points;
    placed.push_back({p, {mesh.points[p[0]], mesh.points[p[1]], mesh.points[p[2]]}});
  }
  return placed;
}

BoxTree tree_of(const std::vector<PlacedTriangle>& triangles) {
  std::vector<Box3> boxes(triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const Vec3& corner : triangles[t].corners) boxes[t].extend(corner);
  }
  return BoxTree(boxes);
}

/// The corners that two triangles share, and the other corners of each.
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
  const Triangle first = exact_triangle(a), second = exact_triangle(b);
  if (first.is_degenerate() || second.is_degenerate()) return false;
  const Pairing pair(a, b);
  const auto& s = pair.shared;
  switch (pair.shared_count) {
    case 0:
      return CGAL::do_intersect(first, second);
    case 1:
      // If they have more than the corner in common, the intersection reaches the edge of one of them that is
      // opposite to it.
      return CGAL::do_intersect(first, Segment(pair.of_b[0], pair.of_b[1])) ||
             CGAL::do_intersect(second, Segment(pair.of_a[0], pair.of_a[1]));
    case 2:
      return CGAL::coplanar(s[0], s[1], pair.of_a[0], pair.of_b[0]) &&
             CGAL::coplanar_orientation(s[0], s[1], pair.of_a[0], pair.of_b[0]) == CGAL::POSITIVE;
    default:
      return true;
  }
}

bool tetrahedron_contains(const std::array<Vec3, 4>& tetrahedron, const Vec3& p) {
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

SelfIntersections find_self_intersections(const InterfaceMesh& mesh) {
  std::vector<PlacedTriangle> placed = placed_triangles(mesh);
  const std::vector<std::uint32_t> welded = weld_points(mesh.points);
  for (PlacedTriangle& t : placed) {
    for (std::uint32_t& p : t.points) p = welded[p];
  }
  SelfIntersections result;
  std::mutex mutex;
  tree_of(placed).for_each_touching_pair([&](std::uint32_t i, std::uint32_t j) {
    if (share_point(placed[i], placed[j])) return;
    const Triangle first = exact_triangle(placed[i]), second = exact_triangle(placed[j]);
    if (first.is_degenerate() || second.is_degenerate() || !CGAL::do_intersect(first, second)) return;
    const Pair pair{i, j};
    const std::lock_guard lock(mutex);
    ++result.count;
    if (!result.first || pair < *result.first) result.first = pair;
  });
  return result;
}

std::vector<Pair> find_contacts(const InterfaceMesh& mesh) {
  const std::vector<PlacedTriangle> placed = placed_triangles(mesh);
  std::vector<Pair> pairs;
  std::mutex mutex;
  tree_of(placed).for_each_touching_pair([&](std::uint32_t i, std::uint32_t j) {
    if (!in_contact(placed[i], placed[j])) return;
    const std::lock_guard lock(mutex);
    pairs.push_back({i, j});
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace adamas::interfaces
