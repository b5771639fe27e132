#include "interfaces/resampling/far_points.h"

namespace adamas::interfaces {

bool has_far_point_in(const Tetrahedron& cell, const std::array<Vec3, 3>& triangle,
                      const ClosestPointTree& surface, double target) {
  Weights middle{};
  double count = 0;
  for (const Weights& w : ClippedTriangle(cell, triangle[0], triangle[1], triangle[2])) {
    if (!surface.is_within(cell.point(w), target)) return true;
    for (std::size_t v = 0; v < 4; ++v) middle[v] += w[v];
    ++count;
  }
  for (double& w : middle) w /= count;
  return count > 0 && !surface.is_within(cell.point(middle), target);
}

}  // namespace adamas::interfaces
