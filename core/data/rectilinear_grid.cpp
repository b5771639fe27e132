#include <algorithm>
#include <limits>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"

namespace adamas {

RectilinearGrid RectilinearGrid::uniform(const std::array<std::size_t, 3>& sites, const Vec3& origin,
                                         const Vec3& spacing, Centering centering) {
  RectilinearGrid grid;
  grid.centering = centering;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    grid.nodes[a].resize(sites[a] + (centering == Centering::kCells ? 1 : 0));
    for (std::size_t i = 0; i < grid.nodes[a].size(); ++i)
      grid.nodes[a][i] = origin[axis] + static_cast<double>(i) * spacing[axis];
  }
  return grid;
}

double RectilinearGrid::least_spacing() const {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& x : nodes) {
    for (std::size_t i = 1; i < x.size(); ++i) least = std::min(least, x[i] - x[i - 1]);
  }
  return least;
}

double RectilinearGrid::site_extent(int axis, std::size_t i) const {
  const auto& x = nodes[static_cast<std::size_t>(axis)];
  if (centering == Centering::kCells) return x[i + 1] - x[i];
  const double low = i == 0 ? x[0] : 0.5 * (x[i - 1] + x[i]);
  const double high = i + 1 == x.size() ? x.back() : 0.5 * (x[i] + x[i + 1]);
  return high - low;
}

double RectilinearGrid::site_volume(std::size_t i, std::size_t j, std::size_t k) const {
  return site_extent(0, i) * site_extent(1, j) * site_extent(2, k);
}

}  // namespace adamas
