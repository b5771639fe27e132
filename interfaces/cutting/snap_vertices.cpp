#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "interfaces/cutting/local_changes.h"

namespace adamas::interfaces {

namespace {

constexpr int kSweeps = 3;
/// Vertices that would move by less than this part of the tolerance stay.
constexpr double kNothing = 1e-3;
/// The cells round a vertex that moves keep this part of the least quality that they had, or have this
/// quality.
constexpr double kKept = 0.3, kGood = 0.1;

}  // namespace

void snap_vertices(LabelledMesh& mesh, const InterfaceTarget& target) {
  struct Snap {
    std::uint32_t vertex;
    LabelledMesh::Sides sides;
    Vec3 step;  ///< to where it should be, as far as the box lets it; zero where there is nothing to gain
  };
  std::vector<Snap> snaps;
  for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
    const auto sides = mesh.sides(v);
    if (sides.bodies() > 1) snaps.push_back({v, sides, {}});
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    parallel_for(snaps.size(), 512, [&](std::size_t i) {
      Snap& snap = snaps[i];
      const Vec3& p = mesh.point(snap.vertex);
      const auto goal = target.closest(snap.sides, p, longest_edge(mesh, snap.vertex));
      snap.step = goal ? *goal - p : Vec3{};
      for (int axis = 0; axis < 3; ++axis) {
        if ((mesh.walls(snap.vertex) >> (2 * axis) & 3u) != 0) snap.step[axis] = 0;
      }
      if (norm(snap.step) < kNothing * target.tolerance()) snap.step = {};
    });
    std::erase_if(snaps, [](const Snap& snap) { return snap.step == Vec3{}; });
    for (const Snap& snap : snaps) {
      const std::uint32_t v = snap.vertex;
      const Vec3 p = mesh.point(v);
      const double bound = std::min(kGood, kKept * least_quality(mesh, mesh.star(v)));
      for (const double part : {1.0, 0.6, 0.3}) {
        const Vec3 q = p + part * snap.step;
        if (quality_at(mesh, v, q, bound) <= bound) continue;
        mesh.move(v, q);
        break;
      }
    }
  }
}

}  // namespace adamas::interfaces
