// This file makes meshes by CGAL's Mesh_3 from both kinds of input. It is one file so that CGAL's headers are
// compiled only once.

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
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
#include <unordered_map>

#include "core/base/disjoint_sets.h"
#include "interfaces/reference_program/answers.h"

namespace adamas::interfaces::reference {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Mesh_polyhedron_3<Kernel>::type;
using Clock = std::chrono::steady_clock;

template <class Domain>
using Triangulation = typename CGAL::Mesh_triangulation_3<Domain, CGAL::Default, CGAL::Sequential_tag>::type;

/// The types of meshes of a polyhedral complex.
struct Patches {
  using Domain = CGAL::Polyhedral_complex_mesh_domain_3<Kernel, Surface>;
  using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation<Domain>, Domain::Corner_index,
                                                          Domain::Curve_index>;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation<Domain>>;
};

/// The types of meshes of a labelled image.
struct Labels {
  using Domain = CGAL::Labeled_mesh_domain_3<Kernel>;
  using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation<Domain>>;
  using Criteria = CGAL::Mesh_criteria_3<Triangulation<Domain>>;
};

/// Returns the triangles of each connected part of a patch. Mesh_3 gets each part separately, since it seeks
/// initial points on each given surface and would miss small parts.
std::vector<std::vector<std::uint32_t>> connected_parts(const MesherRequest& request) {
  const std::size_t count = request.triangles.size();
  DisjointSets sets(count);
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first;  // by triangle of a patch and point
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const std::uint32_t point : request.triangles[t]) {
      const auto [entry, fresh] = first.try_emplace({request.triangle_patches[t], point}, t);
      if (!fresh) sets.join(t, entry->second);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> parts;
  for (std::uint32_t t = 0; t < count; ++t) parts[sets.find(t)].push_back(t);
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
  // A surface that touches itself is cut open there, since a polyhedron has at most two triangles at an edge.
  CGAL::Polygon_mesh_processing::orient_polygon_soup(points, triangles);
  Surface surface;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles, surface);
  return surface;
}

/// Appends the tetrahedra of a complex that Mesh_3 has made, and their regions, to a reply.
template <class Complex>
void take_complex(const Complex& complex, MesherReply& reply) {
  std::unordered_map<typename Complex::Vertex_handle, std::uint32_t> number;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    std::array<std::uint32_t, 4> corners;
    for (int i = 0; i < 4; ++i) {
      const auto vertex = cell->vertex(i);
      const auto [entry, fresh] = number.try_emplace(vertex, static_cast<std::uint32_t>(reply.points.size()));
      if (fresh) {
        const auto& p = vertex->point().point();
        reply.points.push_back({p.x(), p.y(), p.z()});
      }
      corners[static_cast<std::size_t>(i)] = entry->second;
    }
    reply.tetrahedra.push_back(corners);
    reply.regions.push_back(static_cast<std::uint32_t>(complex.subdomain_index(cell)));
  }
}

/// Meshes the domain. `improve` is called with the complex before the clock stops.
template <class Kind, class Improve>
MesherReply mesh(typename Kind::Domain& domain, const typename Kind::Criteria& criteria,
                 Clock::time_point start, const Improve& improve) {
  using namespace CGAL::parameters;
  MesherReply reply;
  auto complex = CGAL::make_mesh_3<typename Kind::Complex>(domain, criteria, no_perturb(), no_exude());
  improve(complex);
  reply.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  take_complex(complex, reply);
  if (reply.tetrahedra.empty()) reply.failure = "Mesh_3 made no tetrahedra";
  return reply;
}

/// The error of points of surfaces, which are found by bisection, relative to the domain's size.
constexpr double kPrecision = 1e-6;

/// Returns the number of the box between walls in which a coordinate lies; outside, -1 or a number beyond the
/// last box.
std::ptrdiff_t box_of(const std::vector<double>& walls, double x) {
  return std::upper_bound(walls.begin(), walls.end(), x) - walls.begin() - 1;
}

/// Returns the region at a point: its label + 1; 0 outside.
int region_at(const LabelImage& image, const Kernel::Point_3& p) {
  const std::ptrdiff_t i = box_of(image.walls_x, p.x()), j = box_of(image.walls_y, p.y()),
                       k = box_of(image.walls_z, p.z());
  const std::ptrdiff_t nx = std::ssize(image.walls_x) - 1, ny = std::ssize(image.walls_y) - 1,
                       nz = std::ssize(image.walls_z) - 1;
  if (std::min({i, j, k}) < 0 || i >= nx || j >= ny || k >= nz) return 0;
  return image.labels[static_cast<std::size_t>(i + nx * (j + ny * k))] + 1;
}

/// Returns a box slightly larger than the image, so that the image's sides lie inside.
CGAL::Bbox_3 bounds_of(const LabelImage& image) {
  const auto range = [](const std::vector<double>& walls) {
    const double margin = 0.01 * (walls.back() - walls.front());
    return std::pair(walls.front() - margin, walls.back() + margin);
  };
  const auto [x0, x1] = range(image.walls_x);
  const auto [y0, y1] = range(image.walls_y);
  const auto [z0, z1] = range(image.walls_z);
  return {x0, y0, z0, x1, y1, z1};
}

/// Seeds CGAL's random numbers, which otherwise depend on the time.
void seed() { CGAL::get_default_random() = CGAL::Random(0); }

}  // namespace

MesherReply run_mesh3(const MesherRequest& request) {
  seed();
  std::vector<Surface> surfaces;
  std::vector<std::pair<int, int>> regions;  // the regions behind and in front
  for (const auto& part : connected_parts(request)) {
    surfaces.push_back(make_surface(request, part));
    const auto& [front, back] = request.patch_regions[request.triangle_patches[part.front()]];
    regions.emplace_back(static_cast<int>(back), static_cast<int>(front));
  }
  const auto start = Clock::now();
  Patches::Domain domain(surfaces.begin(), surfaces.end(), regions.begin(), regions.end());
  domain.detect_borders();
  using namespace CGAL::parameters;
  const Mesh3Criteria& c = request.criteria;
  const Patches::Criteria criteria(
      edge_size = c.edge_size > 0 ? c.edge_size : std::numeric_limits<double>::max(),
      facet_angle = c.facet_angle, facet_distance = c.facet_distance,
      cell_radius_edge_ratio = c.radius_edge_ratio);
  return mesh<Patches>(domain, criteria, start, [&](Patches::Complex& complex) {
    if (c.optimise == 0) return;
    CGAL::perturb_mesh_3(complex, domain);
    CGAL::exude_mesh_3(complex);
  });
}

MesherReply run_mesh3_labels(const MesherRequest& request) {
  seed();
  const LabelImage& image = request.image;
  const auto start = Clock::now();
  Labels::Domain domain([&image](const Kernel::Point_3& p) { return region_at(image, p); }, bounds_of(image),
                        kPrecision);
  using namespace CGAL::parameters;
  const Mesh3Criteria& c = request.criteria;
  const Labels::Criteria criteria(facet_angle = c.facet_angle, facet_distance = c.facet_distance,
                                  cell_radius_edge_ratio = c.radius_edge_ratio);
  return mesh<Labels>(domain, criteria, start, [](const Labels::Complex&) {});
}

}  // namespace adamas::interfaces::reference
