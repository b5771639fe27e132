#include <algorithm>
#include <cmath>
#include <limits>

#include "interfaces/cutting/local_changes.h"

namespace adamas {

namespace {

constexpr int kSweeps = 3;
/// Cells round a vertex keep so much of the least quality that they had, or this quality.
constexpr double kKept = 0.3, kGood = 0.1;

double quality_at(const LabelledMesh& mesh, std::uint32_t v, const Vec3& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t c : mesh.star(v)) {
    const auto& corners = mesh.cell(c).vertices;
    std::array<Vec3, 4> x;
    for (std::size_t i = 0; i < 4; ++i) x[i] = corners[i] == v ? p : mesh.point(corners[i]);
    least = std::min(least, least_dihedral_sine(x[0], x[1], x[2], x[3]));
  }
  return least;
}

double longest_edge(const LabelledMesh& mesh, std::uint32_t v) {
  double longest = 0;
  for (const std::uint32_t c : mesh.star(v)) {
    for (const std::uint32_t w : mesh.cell(c).vertices)
      longest = std::max(longest, squared_norm(mesh.point(w) - mesh.point(v)));
  }
  return std::sqrt(longest);
}

}  // namespace

void snap_vertices(LabelledMesh& mesh, const InterfaceTarget& target) {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
      const auto sides = mesh.sides(v);
      if (sides.bodies() < 2) continue;
      const Vec3& p = mesh.point(v);
      const auto goal = target.closest(sides, p, longest_edge(mesh, v));
      if (!goal) continue;
      Vec3 step = *goal - p;
      for (int axis = 0; axis < 3; ++axis) {
        if ((mesh.walls(v) >> (2 * axis) & 3u) != 0) step[axis] = 0;
      }
      // Nothing to gain.
      if (norm(step) < 1e-3 * target.tolerance()) continue;
      const double bound = std::min(kGood, kKept * least_quality(mesh, mesh.star(v)));
      for (const double part : {1.0, 0.6, 0.3}) {
        const Vec3 q = p + part * step;
        if (quality_at(mesh, v, q) <= bound) continue;
        mesh.move(v, q);
        break;
      }
    }
  }
}

}  // namespace adamas
