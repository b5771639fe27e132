#include <algorithm>
#include <limits>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"

namespace adamas {

namespace {

double extent(const std::vector<double>& nodes, Centering centering, std::size_t i) {
  if (centering == Centering::kCells) return nodes[i + 1] - nodes[i];
  const double low = i == 0 ? nodes[0] : 0.5 * (nodes[i - 1] + nodes[i]);
  const double high = i + 1 == nodes.size() ? nodes.back() : 0.5 * (nodes[i] + nodes[i + 1]);
  return high - low;
}

}  // namespace

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

double RectilinearGrid::site_volume(std::size_t i, std::size_t j, std::size_t k) const {
  return extent(nodes[0], centering, i) * extent(nodes[1], centering, j) * extent(nodes[2], centering, k);
}

}  // namespace adamas
