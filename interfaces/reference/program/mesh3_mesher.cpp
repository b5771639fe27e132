#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polyhedral_complex_mesh_domain_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>

#include "interfaces/reference/program/meshers.h"

namespace adamas::interfaces::reference {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Mesh_polyhedron_3<Kernel>::type;
using MeshDomain = CGAL::Polyhedral_complex_mesh_domain_3<Kernel, Surface>;
using Triangulation = CGAL::Mesh_triangulation_3<MeshDomain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex =
    CGAL::Mesh_complex_3_in_triangulation_3<Triangulation, MeshDomain::Corner_index, MeshDomain::Curve_index>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The triangles of each connected part of a patch: parts are given to Mesh_3 one by one, since it looks for
/// initial points on each surface that it is given, and would miss small parts.
std::vector<std::vector<std::uint32_t>> connected_parts(const MesherRequest& request) {
  const std::size_t count = request.triangles.size();
  std::vector<std::uint32_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t t) {
    while (parent[t] != t) t = parent[t] = parent[parent[t]];
    return t;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first;  // of a patch and point
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const std::uint32_t point : request.triangles[t]) {
      const auto [entry, fresh] = first.try_emplace({request.triangle_patches[t], point}, t);
      if (!fresh) parent[std::max(root(t), root(entry->second))] = std::min(root(t), root(entry->second));
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> parts;
  for (std::uint32_t t = 0; t < count; ++t) parts[root(t)].push_back(t);
  std::vector<std::vector<std::uint32_t>> result;
  for (auto& [name, part] : parts) result.push_back(std::move(part));
  return result;
}

Surface make_surface(const MesherRequest& request, const std::vector<std::uint32_t>& part) {
  std::vector<Kernel::Point_3> points;
  std::vector<std::vector<std::size_t>> triangles;
  std::unordered_map<std::uint32_t, std::size_t> number;
  for (const std::uint32_t t : part) {
    triangles.emplace_back();
    for (const std::uint32_t point : request.triangles[t]) {
      const auto [entry, fresh] = number.try_emplace(point, points.size());
      const Vec3& p = request.points[point];
      if (fresh) points.emplace_back(p.x, p.y, p.z);
      triangles.back().push_back(entry->second);
    }
  }
  // Where the surface touches itself it is cut open, since a polyhedron has two triangles at an edge at most.
  CGAL::Polygon_mesh_processing::orient_polygon_soup(points, triangles);
  Surface surface;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return surface;
}

Criteria make_criteria(const Mesh3Criteria& c) {
  using namespace CGAL::parameters;
  const double edge_size = c.edge_size > 0 ? c.edge_size : std::numeric_limits<double>::max();
  return Criteria(CGAL::parameters::edge_size = edge_size, facet_angle = c.facet_angle,
                  facet_distance = c.facet_distance, cell_radius_edge_ratio = c.radius_edge_ratio);
}

}  // namespace

MesherReply run_mesh3(const MesherRequest& request) {
  MesherReply reply;
  // Otherwise seeded by the clock.
  CGAL::get_default_random() = CGAL::Random(0);
  std::vector<Surface> surfaces;
  std::vector<std::pair<int, int>> regions;  // behind and in front
  for (const auto& part : connected_parts(request)) {
    surfaces.push_back(make_surface(request, part));
    const auto& [front, back] = request.patch_regions[request.triangle_patches[part.front()]];
    regions.emplace_back(static_cast<int>(back), static_cast<int>(front));
  }
  const auto start = Clock::now();
  MeshDomain domain(surfaces.begin(), surfaces.end(), regions.begin(), regions.end());
  domain.detect_borders();
  using namespace CGAL::parameters;
  auto complex =
      CGAL::make_mesh_3<Complex>(domain, make_criteria(request.criteria), no_perturb(), no_exude());
  if (request.criteria.optimise != 0) {
    CGAL::perturb_mesh_3(complex, domain);
    CGAL::exude_mesh_3(complex);
  }
  reply.seconds = seconds_since(start);
  take_complex(complex, reply);
  if (reply.tetrahedra.empty()) reply.failure = "Mesh_3 made no tetrahedra";
  return reply;
}

}  // namespace adamas::interfaces::reference
