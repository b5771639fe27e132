#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <unordered_map>
#include <utility>

#include "interfaces/reference_program/answers.h"

namespace adamas::interfaces::reference {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertex = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
using Cell = CGAL::Constrained_triangulation_face_base_2<Kernel>;
using Structure = CGAL::Triangulation_data_structure_2<Vertex, Cell>;
using Triangulation =
    CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure,
                                               CGAL::No_constraint_intersection_requiring_constructions_tag>;

/// A range of indices.
struct Range {
  std::uint32_t begin, end;
};

/// Appends the triangulation of one plane; returns false if two segments cross or a point lies on one.
bool add_plane(const PlanarRequest& request, Range points, Range segments, PlanarReply& reply) {
  std::vector<std::pair<Kernel::Point_2, std::uint32_t>> located;
  located.reserve(points.end - points.begin);
  for (std::uint32_t i = points.begin; i < points.end; ++i)
    located.emplace_back(Kernel::Point_2(request.points[i][0], request.points[i][1]), i);
  Triangulation triangulation;
  triangulation.insert(located.begin(), located.end());
  std::unordered_map<std::uint32_t, Triangulation::Vertex_handle> handles;
  for (const auto vertex : triangulation.finite_vertex_handles()) handles.emplace(vertex->info(), vertex);
  try {
    for (std::uint32_t s = segments.begin; s < segments.end; ++s)
      triangulation.insert_constraint(handles.at(request.segments[s][0]), handles.at(request.segments[s][1]));
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return false;
  }
  for (const auto face : triangulation.finite_face_handles())
    reply.triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  return true;
}

}  // namespace

PlanarReply triangulate_planes(const PlanarRequest& request) {
  PlanarReply reply;
  Range points{0, 0}, segments{0, 0};
  for (std::size_t plane = 0; plane < request.point_ends.size(); ++plane) {
    points = {points.end, request.point_ends[plane]};
    segments = {segments.end, request.segment_ends[plane]};
    if (!add_plane(request, points, segments, reply)) {
      reply.failure = "expected interfaces that do not cross on the boundary of the box, found some that do";
      return reply;
    }
    reply.triangle_ends.push_back(static_cast<std::uint32_t>(reply.triangles.size()));
  }
  return reply;
}

}  // namespace adamas::interfaces::reference
