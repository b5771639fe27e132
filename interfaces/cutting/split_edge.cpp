#include <algorithm>
#include <limits>

#include "interfaces/cutting/local_changes.h"

namespace adamas::interfaces {

bool split_edge(const LabelledMesh& mesh, std::uint32_t a, std::uint32_t b, LocalChange& change) {
  constexpr double kMargin = 0.1;  // of the edge, from its ends
  if (a > b) std::swap(a, b);
  mesh.cells_at_edge(a, b, change.removed);
  const double before = least_quality(mesh, change.removed);
  const Vec3 &from = mesh.point(a), edge = mesh.point(b) - from;
  thread_local std::vector<double> places;
  places.assign(1, 0.5);
  for (const std::uint32_t c : change.removed) {
    for (const std::uint32_t v : mesh.cell(c).vertices) {
      const double t = dot(mesh.point(v) - from, edge) / squared_norm(edge);
      if (t > kMargin && t < 1 - kMargin) places.push_back(t);
    }
  }
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
  change.quality = before;
  change.has_vertex = false;
  for (const double t : places) {
    const Vec3 p = from + t * edge;
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t c : change.removed) {
      std::array<Vec3, 4> x;
      for (const std::uint32_t end : {a, b}) {
        for (std::size_t i = 0; i < 4; ++i) {
          const std::uint32_t v = mesh.cell(c).vertices[i];
          x[i] = v == end ? p : mesh.point(v);
        }
        least = std::min(least, least_dihedral_sine(x[0], x[1], x[2], x[3]));
      }
      if (least <= change.quality) break;
    }
    if (least > change.quality) change.quality = least, change.point = p, change.has_vertex = true;
  }
  if (!change.has_vertex) return false;
  change.walls = mesh.walls(a) & mesh.walls(b);
  change.added.clear();
  const auto middle = static_cast<std::uint32_t>(mesh.vertex_count());
  for (const std::uint32_t c : change.removed) {
    for (const std::uint32_t end : {a, b}) {
      LabelledMesh::Cell cell = mesh.cell(c);
      std::replace(cell.vertices.begin(), cell.vertices.end(), end, middle);
      change.added.push_back(cell);
    }
  }
  return true;
}

}  // namespace adamas::interfaces
