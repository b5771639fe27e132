#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/grid_data.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/grid_sites.h"

namespace adamas::interfaces {

/// A box of a grid's sites and smoothing of arrays on it. An array has a number for each site of the box, x
/// fastest.
class SiteBox {
 public:
  using Index = std::array<std::size_t, 3>;

  /// The sites from `low` to below `high` along each axis. The grid must outlive the box.
  SiteBox(const RectilinearGrid& grid, const Index& low, const Index& high);

  /// Returns a box round sites with a margin of `margin` sites on each side, cut off at the end of the grid.
  static SiteBox round(const RectilinearGrid& grid, const std::vector<std::uint32_t>& sites,
                       std::size_t margin);

  [[nodiscard]] std::size_t size() const { return n_[0] * n_[1] * n_[2]; }
  [[nodiscard]] std::size_t sites(int axis) const { return n_[static_cast<std::size_t>(axis)]; }
  /// Returns the index of the first site along an axis.
  [[nodiscard]] std::size_t low(int axis) const { return low_[static_cast<std::size_t>(axis)]; }
  /// Returns the index in arrays of a site that lies in the box.
  [[nodiscard]] std::size_t place(std::size_t site) const {
    const Index p = sites_.indices(site);
    return p[0] - low_[0] + n_[0] * (p[1] - low_[1] + n_[1] * (p[2] - low_[2]));
  }
  [[nodiscard]] bool contains(std::size_t site) const;
  /// Calls visit(place, site) for all sites; planes z = const are visited in parallel.
  template <class Visit>
  void for_each(const Visit& visit) const {
    parallel_for(n_[2], 1, [&](std::size_t k) {
      for (std::size_t j = 0; j < n_[1]; ++j) {
        const std::size_t place = n_[0] * (j + n_[1] * k),
                          site = grid_.site_index(low_[0], low_[1] + j, low_[2] + k);
        for (std::size_t i = 0; i < n_[0]; ++i) visit(place + i, site + i);
      }
    });
  }

  /// Computes the squared gradient of an array by central differences, one-sided on the domain's border;
  /// lengths are in the grid's unit. `widened`: the sum over axes of n^4 h^2, with the normal n and half the
  /// distance h of the two sites of a difference; a third of it is the error of central differences in the
  /// variance of a step.
  void squared_gradient(const std::vector<float>& values, std::vector<float>& squared,
                        std::vector<float>& widened) const;

  /// Spreads an array by diffusion to neighbours along each axis. `variance` is in the square of the unit of
  /// length. Nothing leaves the box. `scratch` is working memory.
  void diffuse(std::vector<float>& values, double variance, std::vector<float>& scratch) const;
  /// Spreads an array by a variance that is in squares of the distance of sites along each axis, whatever
  /// that distance is.
  void blend(std::vector<float>& values, double variance, std::vector<float>& scratch) const;
  /// Marks all sites within `reach` sites of a marked one along each axis.
  void dilate(std::vector<std::uint8_t>& marks, int reach) const;
  /// Returns the greatest variance of one step of diffusion.
  [[nodiscard]] double greatest_step() const;

 private:
  /// The parts of the values of the neighbours before and behind a site that are added to its value.
  struct Share {
    float before, behind;
  };
  [[nodiscard]] std::vector<Share> shares(int axis, double variance, bool in_sites) const;
  void spread(std::vector<float>& values, double variance, bool in_sites, std::vector<float>& scratch) const;

  const RectilinearGrid& grid_;
  GridSites sites_;
  Index low_, n_;
  std::array<std::vector<double>, 3> gaps_;  // the distances from each site to the next
};

}  // namespace adamas::interfaces
