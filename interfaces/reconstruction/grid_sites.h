#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/data/rectilinear_grid.h"

namespace adamas {

/// Sites of a grid by their number, and as neighbours of each other.
class GridSites {
 public:
  explicit GridSites(const RectilinearGrid& grid)
      : grid_(grid), n_{grid.sites(0), grid.sites(1), grid.sites(2)} {}

  /// Calls visit(site, di, dj, dk) for those of the 26 round a site that there are.
  template <class Visit>
  void for_each_neighbour(std::size_t site, Visit&& visit) const {
    const std::array<std::size_t, 3> p = place(site);
    for (int dk = -1; dk <= 1; ++dk) {
      for (int dj = -1; dj <= 1; ++dj) {
        for (int di = -1; di <= 1; ++di) {
          // A step below 0 becomes a number beyond all others.
          const std::size_t i = p[0] + static_cast<std::size_t>(di), j = p[1] + static_cast<std::size_t>(dj),
                            k = p[2] + static_cast<std::size_t>(dk);
          if ((di == 0 && dj == 0 && dk == 0) || i >= n_[0] || j >= n_[1] || k >= n_[2]) continue;
          visit(i + n_[0] * (j + n_[1] * k), di, dj, dk);
        }
      }
    }
  }
  /// The site whose cell holds a point, or is nearest to it.
  [[nodiscard]] std::size_t site_at(const Vec3& p) const {
    std::array<std::size_t, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const auto& x = grid_.nodes[a];
      const auto above = std::upper_bound(x.begin() + 1, x.end() - 1, p[axis]);
      at[a] = static_cast<std::size_t>(above - x.begin()) - 1;
      if (grid_.centering == Centering::kPoints && p[axis] > 0.5 * (x[at[a]] + x[at[a] + 1])) ++at[a];
    }
    return at[0] + n_[0] * (at[1] + n_[1] * at[2]);
  }
  [[nodiscard]] Vec3 position(std::size_t site) const {
    const auto [i, j, k] = place(site);
    return grid_.site(i, j, k);
  }
  /// The cell of a site, as RectilinearGrid::site_volume() has it.
  [[nodiscard]] Box3 cell(std::size_t site) const {
    const std::array<std::size_t, 3> p = place(site);
    Box3 box;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& x = grid_.nodes[static_cast<std::size_t>(axis)];
      const std::size_t i = p[static_cast<std::size_t>(axis)];
      const bool cells = grid_.centering == Centering::kCells;
      box.min[axis] = cells || i == 0 ? x[i] : 0.5 * (x[i - 1] + x[i]);
      box.max[axis] = cells ? x[i + 1] : i + 1 == x.size() ? x[i] : 0.5 * (x[i] + x[i + 1]);
    }
    return box;
  }

 private:
  [[nodiscard]] std::array<std::size_t, 3> place(std::size_t site) const {
    return {site % n_[0], site / n_[0] % n_[1], site / (n_[0] * n_[1])};
  }
  const RectilinearGrid& grid_;
  std::array<std::size_t, 3> n_;
};

}  // namespace adamas
