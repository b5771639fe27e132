#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <vector>

#include "interfaces/network/check.h"
#include "interfaces/network/weld.h"

namespace adamas {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Triangle = Kernel::Triangle_3;

struct Item {
  std::array<std::uint32_t, 3> points;
  std::uint32_t index;
  Triangle triangle;
};
using Box = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const Item*>;

bool share_point(const Item& a, const Item& b) {
  return std::any_of(a.points.begin(), a.points.end(), [&b](std::uint32_t p) {
    return p == b.points[0] || p == b.points[1] || p == b.points[2];
  });
}

std::vector<Item> proper_triangles(const InterfaceMesh& mesh) {
  const std::vector<std::uint32_t> welded = weld_points(mesh.points);
  std::vector<Item> items;
  items.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& p = mesh.triangles[t].points;
    const auto at = [&mesh](std::uint32_t i) {
      return Kernel::Point_3(mesh.points[i].x, mesh.points[i].y, mesh.points[i].z);
    };
    const Triangle triangle(at(p[0]), at(p[1]), at(p[2]));
    if (triangle.is_degenerate()) continue;
    items.push_back({{welded[p[0]], welded[p[1]], welded[p[2]]}, t, triangle});
  }
  return items;
}

}  // namespace

SelfIntersections find_self_intersections(const InterfaceMesh& mesh) {
  const std::vector<Item> items = proper_triangles(mesh);
  std::vector<Box> boxes;
  boxes.reserve(items.size());
  for (const Item& item : items) boxes.emplace_back(item.triangle.bbox(), &item);
  SelfIntersections result;
  const auto visit = [&result](const Box& x, const Box& y) {
    const Item &a = *x.handle(), &b = *y.handle();
    if (share_point(a, b) || !CGAL::do_intersect(a.triangle, b.triangle)) return;
    ++result.count;
    const std::array<std::uint32_t, 2> pair{std::min(a.index, b.index), std::max(a.index, b.index)};
    if (!result.first || pair < *result.first) result.first = pair;
  };
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), visit);
  return result;
}

}  // namespace adamas
