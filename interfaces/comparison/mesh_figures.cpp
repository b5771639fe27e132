#include "interfaces/comparison/mesh_figures.h"

#include "core/distance/hausdorff.h"

namespace adamas::interfaces {

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
  result.to_input = directed_distance_bound({points, triangles}, network.tree(), options, progress).upper;
  result.from_input =
      directed_distance_bound({network.points(), network.triangles()}, tree, options, progress).upper;
  return result;
}

}  // namespace adamas::interfaces
