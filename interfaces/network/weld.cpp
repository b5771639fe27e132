#include "interfaces/network/weld.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace adamas::interfaces {

std::vector<std::uint32_t> weld_points(std::span<const Vec3> points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Vec3 &a = points[i], &b = points[j];
    return std::tie(a.x, a.y, a.z, i) < std::tie(b.x, b.y, b.z, j);
  });
  std::vector<std::uint32_t> welded(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && points[order[i]] == points[order[i - 1]];
    welded[order[i]] = same ? welded[order[i - 1]] : order[i];
  }
  return welded;
}

}  // namespace adamas::interfaces
