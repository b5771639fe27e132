#include <algorithm>
#include <limits>

#include "core/distance/triangle_distance.h"
#include "interfaces/cutting/local_changes.h"

namespace adamas::interfaces {

namespace {

/// Whether the faces that a collapse of the edge from a to b brings together, and what lies between them, may
/// be one.
bool keeps_topology(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b,
                    const LabelledMesh::Sides& sides) {
  thread_local std::vector<std::uint32_t> round_edge, seen;
  mesh.cells_at_edge(a, b, round_edge);
  for (const std::uint32_t c : round_edge) {
    if (is_feature(mesh, c, a) && is_feature(mesh, c, b)) return false;
  }
  if (sides.count < 2) return true;
  seen.clear();
  for (const std::uint32_t c : mesh.star(a)) {
    for (const std::uint32_t w : mesh.cell(c).vertices) {
      if (w == a || w == b || std::find(seen.begin(), seen.end(), w) != seen.end()) continue;
      seen.push_back(w);
      const std::size_t from_a = mesh.sides(a, w).count;
      if (from_a < 2) continue;
      const std::size_t from_b = mesh.sides(b, w).count;
      if (from_b < 2) continue;
      if (from_a > 2 && from_b > 2) return false;
      // A triangle of the interface must lie between the two edges.
      const bool between = std::any_of(round_edge.begin(), round_edge.end(), [&](std::uint32_t d) {
        const auto& v = mesh.cell(d).vertices;
        if (!LabelledMesh::has(v, w)) return false;
        for (const std::uint32_t x : v) {
          if (x != a && x != b && x != w) return is_feature(mesh, d, x);
        }
        return false;
      });
      if (!between) return false;
    }
  }
  return true;
}

/// Whether the interfaces' triangles at a, with b in its place, may be there, and a is not far from them.
bool is_near_target(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a,
                    std::uint32_t b) {
  const Vec3& p = mesh.point(b);
  const bool astray = !target.allows(mesh.sides(a), mesh.point(a));
  double to_a = std::numeric_limits<double>::infinity();
  thread_local std::vector<LabelledMesh::InterfaceFace> faces;
  mesh.interface_faces(a, faces);
  for (const auto& [pair, ends] : faces) {
    if (ends[0] == b || ends[1] == b) continue;
    const Vec3 &x = mesh.point(ends[0]), &y = mesh.point(ends[1]);
    to_a = std::min(to_a, closest_on_triangle(mesh.point(a), {p, x, y}).squared_distance);
    if (!target.allows(pair, (1.0 / 3) * (p + x + y), astray) ||
        !target.allows(pair, 0.5 * (p + x), astray) || !target.allows(pair, 0.5 * (p + y), astray))
      return false;
    for (const std::uint32_t end : ends) {
      const auto line = mesh.sides(a, end);
      if (line.bodies() > 2 && !target.allows(line, 0.5 * (p + mesh.point(end)), astray)) return false;
    }
  }
  return astray || to_a <= target.tolerance() * target.tolerance();
}

}  // namespace

double least_quality(const LabelledMesh& mesh, std::span<const std::uint32_t> cells) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t c : cells) least = std::min(least, mesh.quality(c));
  return least;
}

bool is_feature(const LabelledMesh& mesh, std::uint32_t cell, std::uint32_t v) {
  const std::uint32_t other = mesh.neighbour(cell, v);
  return other == kNoNeighbour || mesh.cell(other).body != mesh.cell(cell).body;
}

bool collapse_edge(const LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t a, std::uint32_t b,
                   double bound, LocalChange& change) {
  if ((mesh.walls(a) & ~mesh.walls(b)) != 0) return false;
  const auto star = mesh.star(a);
  change.removed.assign(star.begin(), star.end());
  change.added.clear();
  change.quality = std::numeric_limits<double>::infinity();
  for (const std::uint32_t c : star) {
    LabelledMesh::Cell cell = mesh.cell(c);
    if (LabelledMesh::has(cell.vertices, b)) continue;
    std::replace(cell.vertices.begin(), cell.vertices.end(), a, b);
    change.quality = std::min(change.quality, mesh.quality_of(cell.vertices));
    if (!(change.quality > bound)) return false;
    change.added.push_back(cell);
  }
  const auto sides = mesh.sides(a);
  if (!(sides == mesh.sides(a, b)) || !keeps_topology(mesh, a, b, sides)) return false;
  return sides.bodies() < 2 || is_near_target(mesh, target, a, b);
}

}  // namespace adamas::interfaces
