#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <chrono>

#include "interfaces/reference/program/meshers.h"

namespace adamas::interfaces::reference {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using MeshDomain = CGAL::Labeled_mesh_domain_3<Kernel>;
using Triangulation = CGAL::Mesh_triangulation_3<MeshDomain, CGAL::Default, CGAL::Sequential_tag>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;
using Clock = std::chrono::steady_clock;

/// Of surfaces that are looked for by halving, in parts of the domain's size.
constexpr double kPrecision = 1e-6;

/// Which box between walls a coordinate is in; none outside.
std::ptrdiff_t box_of(const std::vector<double>& walls, double x) {
  return std::upper_bound(walls.begin(), walls.end(), x) - walls.begin() - 1;
}

/// The label at a point and 1 more; 0 outside.
int region_at(const LabelImage& image, const Kernel::Point_3& p) {
  const std::ptrdiff_t i = box_of(image.walls_x, p.x()), j = box_of(image.walls_y, p.y()),
                       k = box_of(image.walls_z, p.z());
  const std::ptrdiff_t nx = std::ssize(image.walls_x) - 1, ny = std::ssize(image.walls_y) - 1,
                       nz = std::ssize(image.walls_z) - 1;
  if (std::min({i, j, k}) < 0 || i >= nx || j >= ny || k >= nz) return 0;
  return image.labels[static_cast<std::size_t>(i + nx * (j + ny * k))] + 1;
}

/// A little greater than the image, so that its sides lie inside.
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

}  // namespace

MesherReply run_mesh3_labels(const MesherRequest& request) {
  MesherReply reply;
  // Otherwise seeded by the clock.
  CGAL::get_default_random() = CGAL::Random(0);
  const LabelImage& image = request.image;
  const auto start = Clock::now();
  const MeshDomain domain([&image](const Kernel::Point_3& p) { return region_at(image, p); },
                          bounds_of(image), kPrecision);
  using namespace CGAL::parameters;
  const Mesh3Criteria& c = request.criteria;
  const Criteria criteria(facet_angle = c.facet_angle, facet_distance = c.facet_distance,
                          cell_radius_edge_ratio = c.radius_edge_ratio);
  const auto complex = CGAL::make_mesh_3<Complex>(domain, criteria, no_perturb(), no_exude());
  reply.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  take_complex(complex, reply);
  if (reply.tetrahedra.empty()) reply.failure = "Mesh_3 made no tetrahedra";
  return reply;
}

}  // namespace adamas::interfaces::reference
