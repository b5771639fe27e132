#include "interfaces/network/interface_mesh_check.h"

#include <algorithm>
#include <string>

#include "adamas/text.h"
#include "core/base/error.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/network/triangle_contacts.h"

namespace adamas::interfaces {

namespace {

void count_triangles(const InterfaceMesh& mesh, const EdgeFans& fans, InterfaceMeshReport& report) {
  std::vector<char> used(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.triangles) {
    const Vec3 &a = mesh.points[t.points[0]], &b = mesh.points[t.points[1]], &c = mesh.points[t.points[2]];
    if (squared_norm(cross(b - a, c - a)) == 0) {
      ++report.degenerate_triangles;
    } else {
      ++report.triangles;
    }
    for (const std::uint32_t p : t.points) used[fans.welded(p)] = 1;
  }
  report.points = static_cast<std::size_t>(std::count(used.begin(), used.end(), 1));
  if (report.triangles == 0) {
    fail("{}: expected triangles with an area, found none among {}", mesh.source, mesh.triangles.size());
  }
}

void check_edges(const InterfaceMesh& mesh, const EdgeFans& fans, const InterfaceCheckOptions& options,
                 InterfaceMeshReport& report) {
  EdgeFans::Fan fan;
  for (std::size_t edge = 0; edge < fans.size(); ++edge) {
    if (fans.valence(edge) == 1)
      ++(fans.on_domain_boundary(edge) ? report.domain_edges : report.open_border_edges);
    if (fans.valence(edge) > 2) ++report.junction_edges;
    fans.fan(edge, fan);
    if (fan.consistent) continue;
    ++report.flipped_edges;
    if (options.allow_flipped_edges) continue;
    std::string around;
    for (const Blade& b : fan.blades) {
      const int behind = EdgeFans::side_behind(b), ahead = EdgeFans::side_ahead(b);
      around += fmt::format("{}{}: {}|{}", around.empty() ? "" : ", ", b.triangle,
                            mesh.materials[fans.material(b.triangle, behind)],
                            mesh.materials[fans.material(b.triangle, ahead)]);
    }
    const auto [low, high] = fans.ends(edge);
    throw TolerableFault(fmt::format(
        "{}: expected the same material on facing sides round the edge {} to {}, found triangles {} (one is "
        "turned the wrong way or missing)",
        mesh.source, place_text(mesh.points[low]), place_text(mesh.points[high]), around));
  }
}

}  // namespace

void check_interface_arrays(const InterfaceMesh& mesh) {
  if (mesh.triangles.empty()) fail("{}: expected an interface mesh with triangles, found none", mesh.source);
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i];
    if (is_finite(p)) continue;
    fail("{}: expected finite coordinates, found {} at point {}", mesh.source, place_text(p), i);
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const InterfaceTriangle& triangle = mesh.triangles[t];
    for (const std::uint32_t p : triangle.points) {
      if (p >= mesh.points.size()) {
        fail("{}: triangle {}: expected points below {}, found {}", mesh.source, t, mesh.points.size(), p);
      }
    }
    for (const MaterialId m : {triangle.front, triangle.back}) {
      if (m.value >= mesh.materials.size()) {
        fail("{}: triangle {}: expected materials below {}, found {}", mesh.source, t, mesh.materials.size(),
             m.value);
      }
    }
    if (triangle.front == triangle.back) {
      fail("{}: triangle {}: expected two materials, found {} on both sides", mesh.source, t,
           mesh.materials[triangle.front]);
    }
  }
}

InterfaceMeshReport check_interface_mesh(const InterfaceMesh& mesh, const Box3* domain,
                                         const InterfaceCheckOptions& options) {
  check_interface_arrays(mesh);
  InterfaceMeshReport report;
  const EdgeFans fans(mesh, domain);
  count_triangles(mesh, fans, report);
  check_edges(mesh, fans, options, report);
  const SelfIntersections found = find_self_intersections(mesh);
  report.intersections = found.count;
  if (found.count > 0 && !options.allow_intersections) {
    const auto [a, b] = *found.first;
    throw TolerableFault(fmt::format(
        "{}: expected triangles that meet at common points only, found {} pairs that intersect, the first {} "
        "and {} near {}",
        mesh.source, found.count, a, b, place_text(mesh.points[mesh.triangles[a].points[0]])));
  }
  return report;
}

}  // namespace adamas::interfaces
