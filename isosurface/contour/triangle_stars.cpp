#include "isosurface/contour/triangle_stars.h"

#include "core/base/hash.h"
#include "core/base/large_pages.h"

namespace adamas::isosurface {

std::vector<bool> border_points(std::span<const TriangleStars::Triangle> triangles, std::size_t points) {
  // At the border, the sum over the triangles of the following corner less the preceding corner is not zero.
  // Sums are of hashes, so that different sets of points have the same sum only with a probability of 2^-64.
  std::vector<std::uint64_t> sums;
  reserve_in_large_pages(sums, points);
  sums.resize(points);
  for (const auto& t : triangles) {
    const std::array<std::uint64_t, 3> hash{mix64(t[0]), mix64(t[1]), mix64(t[2])};
    sums[t[0]] += hash[1] - hash[2];
    sums[t[1]] += hash[2] - hash[0];
    sums[t[2]] += hash[0] - hash[1];
  }
  std::vector<bool> result(points);
  for (std::size_t p = 0; p < points; ++p) result[p] = sums[p] != 0;
  return result;
}

}  // namespace adamas::isosurface
