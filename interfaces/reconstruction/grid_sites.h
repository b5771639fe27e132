#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"

namespace adamas::interfaces {

/// Finds positions, cells and neighbours of a grid's sites, which are given by their numbers.
class GridSites {
 public:
  explicit GridSites(const RectilinearGrid& grid)
      : grid_(grid), n_{grid.sites(0), grid.sites(1), grid.sites(2)} {}

  /// Returns the indices of a site along the axes.
  [[nodiscard]] std::array<std::size_t, 3> indices(std::size_t site) const {
    return {site % n_[0], site / n_[0] % n_[1], site / (n_[0] * n_[1])};
  }

  /// Calls visit(site, di, dj, dk) for a site and those within `reach` sites of it along each axis, x
  /// fastest, until it returns true; returns whether it has.
  template <class Visit>
  bool any_within(std::size_t site, std::size_t reach, Visit&& visit) const {
    const std::array<std::size_t, 3> p = indices(site);
    std::array<int, 3> least{}, most{};
    for (std::size_t a = 0; a < 3; ++a) {
      least[a] = -static_cast<int>(std::min(p[a], reach));
      most[a] = static_cast<int>(std::min(n_[a] - 1 - p[a], reach));
    }
    const auto nx = static_cast<std::ptrdiff_t>(n_[0]), ny = static_cast<std::ptrdiff_t>(n_[1]);
    for (int dk = least[2]; dk <= most[2]; ++dk) {
      for (int dj = least[1]; dj <= most[1]; ++dj) {
        const auto row = static_cast<std::ptrdiff_t>(site) + nx * (dj + ny * dk);
        for (int di = least[0]; di <= most[0]; ++di) {
          if (visit(static_cast<std::size_t>(row + di), di, dj, dk)) return true;
        }
      }
    }
    return false;
  }
  /// Calls visit(site, di, dj, dk) for all of them.
  template <class Visit>
  void for_each_within(std::size_t site, std::size_t reach, Visit&& visit) const {
    any_within(site, reach, [&](std::size_t other, int di, int dj, int dk) {
      visit(other, di, dj, dk);
      return false;
    });
  }
  /// Calls visit(site, di, dj, dk) for those of the 26 neighbours of a site that exist.
  template <class Visit>
  void for_each_neighbour(std::size_t site, Visit&& visit) const {
    for_each_within(site, 1, [&](std::size_t other, int di, int dj, int dk) {
      if (other != site) visit(other, di, dj, dk);
    });
  }
  /// Returns whether is(site) holds for a neighbour of a site.
  template <class Is>
  [[nodiscard]] bool any_neighbour(std::size_t site, Is&& is) const {
    return any_within(site, 1, [&](std::size_t other, int, int, int) { return other != site && is(other); });
  }
  /// Returns the site whose cell holds a point or is nearest to it.
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
  /// The distances, along the axes, from a site to those within kReach sites of it that exist.
  template <int kReach>
  class Ways {
   public:
    Ways(const RectilinearGrid& grid, const std::array<std::size_t, 3>& place) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const auto at = static_cast<int>(place[a]), count = static_cast<int>(grid.sites(axis));
        const double own = grid.site_coordinate(axis, place[a]);
        for (int d = -std::min(at, kReach); d <= std::min(count - 1 - at, kReach); ++d)
          along_[a][static_cast<std::size_t>(d + kReach)] =
              grid.site_coordinate(axis, static_cast<std::size_t>(at + d)) - own;
      }
    }
    /// Returns the position of the site that is di, dj and dk sites away, relative to the site.
    [[nodiscard]] Vec3 to(int di, int dj, int dk) const { return {along(0, di), along(1, dj), along(2, dk)}; }
    [[nodiscard]] double along(std::size_t axis, int d) const {
      return along_[axis][static_cast<std::size_t>(d + kReach)];
    }

   private:
    std::array<std::array<double, 2 * kReach + 1>, 3> along_{};
  };
  template <int kReach>
  [[nodiscard]] Ways<kReach> ways_round(std::size_t site) const {
    return {grid_, indices(site)};
  }
  [[nodiscard]] Vec3 position(std::size_t site) const {
    const auto [i, j, k] = indices(site);
    return grid_.site(i, j, k);
  }
  /// Returns the cell of a site, whose volume is RectilinearGrid::site_volume().
  [[nodiscard]] Box3 cell(std::size_t site) const {
    const std::array<std::size_t, 3> p = indices(site);
    Box3 box;
    for (int axis = 0; axis < 3; ++axis) {
      const std::array<double, 2> ends = ends_of_cell(axis, p[static_cast<std::size_t>(axis)]);
      box.min[axis] = ends[0];
      box.max[axis] = ends[1];
    }
    return box;
  }
  /// Returns whether the cells of a site and of its neighbours have exactly the same sides.
  [[nodiscard]] bool has_even_cells_round(std::size_t site) const {
    const std::array<std::size_t, 3> p = indices(site);
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const auto length = [&](std::size_t i) {
        const std::array<double, 2> ends = ends_of_cell(axis, i);
        return ends[1] - ends[0];
      };
      const double own = length(p[a]);
      if (p[a] > 0 && length(p[a] - 1) != own) return false;
      if (p[a] + 1 < n_[a] && length(p[a] + 1) != own) return false;
    }
    return true;
  }

  /// Returns the length of the shortest side of a site's cell.
  [[nodiscard]] double least_side(std::size_t site) const {
    const Vec3 size = cell(site).size();
    return std::min({size.x, size.y, size.z});
  }

 private:
  /// Returns the ends, along an axis, of the cell of site i.
  [[nodiscard]] std::array<double, 2> ends_of_cell(int axis, std::size_t i) const {
    const auto& x = grid_.nodes[static_cast<std::size_t>(axis)];
    if (grid_.centering == Centering::kCells) return {x[i], x[i + 1]};
    return {i == 0 ? x[i] : 0.5 * (x[i - 1] + x[i]), i + 1 == x.size() ? x[i] : 0.5 * (x[i] + x[i + 1])};
  }

  const RectilinearGrid& grid_;
  std::array<std::size_t, 3> n_;
};

}  // namespace adamas::interfaces
