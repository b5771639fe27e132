#include "interfaces/reference/mesh_figures.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interfaces/network/hausdorff.h"

namespace adamas {

void DihedralRange::add(const std::array<Vec3, 4>& x) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) {
      // The faces at the edge from i to j, each with one of the other two corners.
      std::array<std::size_t, 2> other{};
      for (std::size_t k = 0, n = 0; k < 4; ++k) {
        if (k != i && k != j) other[n++] = k;
      }
      const Vec3 a = cross(x[j] - x[i], x[other[0]] - x[i]), b = cross(x[j] - x[i], x[other[1]] - x[i]);
      const double angle = std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
      min = std::min(min, angle);
      max = std::max(max, angle);
    }
  }
}

TwoSidedDistance measure_distance(const ResamplingSource& source, std::span<const Vec3> points,
                                  std::span<const ClosestPointTree::Triangle> triangles, double target,
                                  const Progress& progress) {
  const InterfaceNetwork& network = *source.network;
  HausdorffOptions options;
  options.domain = source.box;
  options.relative = 0.01;
  options.accept = 0.01 * target;
  const ClosestPointTree tree(points, triangles);
  TwoSidedDistance result;
  result.to_input = directed_distance_bound(points, triangles, network.tree(), options, progress).upper;
  result.from_input =
      directed_distance_bound(network.points(), network.triangles(), tree, options, progress).upper;
  return result;
}

}  // namespace adamas
