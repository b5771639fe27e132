#include "interfaces/reference/face_triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <unordered_map>

#include "core/base/error.h"

namespace adamas {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Cell = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex, Cell>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulate_box_side(
    const std::vector<Vec3>& points, const std::vector<std::uint32_t>& on_side,
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& segments, int side) {
  const int axis = side / 2;
  // So that counter-clockwise in the plane is so seen from outside.
  const int u = (axis + (side % 2 == 1 ? 1 : 2)) % 3, v = (axis + (side % 2 == 1 ? 2 : 1)) % 3;
  std::vector<std::pair<Kernel::Point_2, std::uint32_t>> located;
  located.reserve(on_side.size());
  for (const std::uint32_t i : on_side) located.emplace_back(Kernel::Point_2(points[i][u], points[i][v]), i);
  Triangulation triangulation;
  triangulation.insert(located.begin(), located.end());
  std::unordered_map<std::uint32_t, Triangulation::Vertex_handle> handles;
  for (const auto vertex : triangulation.finite_vertex_handles()) handles.emplace(vertex->info(), vertex);
  try {
    for (const auto& [a, b] : segments) triangulation.insert_constraint(handles.at(a), handles.at(b));
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    fail("expected interfaces that do not cross on the boundary of the box, found some that do");
  }
  std::vector<std::array<std::uint32_t, 3>> result;
  for (const auto face : triangulation.finite_face_handles())
    result.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  return result;
}

}  // namespace adamas
