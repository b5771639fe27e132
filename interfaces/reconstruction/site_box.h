#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/grid_data.h"
#include "core/base/parallel.h"
#include "interfaces/reconstruction/grid_sites.h"

namespace adamas::interfaces {

/// The places of a box whose values are still needed while an array is diffused, step after step. A value
/// after some steps depends on the values within as many sites along each axis.
class DiffusionNeeds {
 public:
  /// A place whose value is needed after `last` steps, and perhaps after fewer.
  struct Target {
    std::size_t place;
    std::uint16_t last;
  };
  /// `n`: the numbers of sites of the box along the axes.
  DiffusionNeeds(const std::array<std::size_t, 3>& n, const std::vector<Target>& targets);

  /// Calls visit(begin, end) for the ranges of a row of the box that contain all places of the row from whose
  /// values after `steps` steps a target's value is computed. Rows are numbered as their first places.
  template <class Visit>
  void for_each_range(std::size_t row, std::size_t steps, const Visit& visit) const {
    const std::uint16_t* of_row = steps_.data() + row * blocks_;
    for (std::size_t b = 0; b < blocks_; ++b) {
      if (of_row[b] <= steps) continue;
      const std::size_t begin = b;
      while (b < blocks_ && of_row[b] > steps) ++b;
      visit(begin * kBlock, std::min(b * kBlock, row_));
    }
  }

 private:
  static constexpr std::size_t kBlock = 16;

  std::size_t row_, blocks_;          // the number of places and of blocks of places in a row
  std::vector<std::uint16_t> steps_;  // by block: one more than the last step after which a value is needed
};

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
    const Index p = indices(site);
    return p[0] + n_[0] * (p[1] + n_[1] * p[2]);
  }
  /// Returns the site at a place.
  [[nodiscard]] std::size_t site(std::size_t place) const {
    return grid_.site_index(low_[0] + place % n_[0], low_[1] + place / n_[0] % n_[1],
                            low_[2] + place / (n_[0] * n_[1]));
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

  /// Calls visit(place, site, count) for each row of `count` sites along x, with its first site and the place
  /// of this.
  template <class Visit>
  void for_each_row(const Visit& visit) const {
    for (std::size_t k = 0; k < n_[2]; ++k) {
      for (std::size_t j = 0; j < n_[1]; ++j)
        visit(n_[0] * (j + n_[1] * k), grid_.site_index(low_[0], low_[1] + j, low_[2] + k), n_[0]);
    }
  }
  /// Returns the part of this box that begins `first` sites from its low corner and has so many sites along
  /// the axes.
  [[nodiscard]] SiteBox part(const Index& first, const Index& count) const {
    Index low{}, high{};
    for (std::size_t a = 0; a < 3; ++a) low[a] = low_[a] + first[a], high[a] = low[a] + count[a];
    return {grid_, low, high};
  }
  /// Returns the part of this box that begins `first` sites from its low corner, is `side` sites long along
  /// each axis and is extended by `margin` sites on each side, as far as this box reaches.
  [[nodiscard]] SiteBox part(const Index& first, std::size_t side, std::size_t margin) const {
    Index low{}, high{};
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = low_[a] + first[a] - std::min(first[a], margin);
      high[a] = low_[a] + std::min(first[a] + side + margin, n_[a]);
    }
    return {grid_, low, high};
  }

  /// The square of a gradient by central differences, and `widened` as in squared_gradient().
  struct SquaredGradient {
    float squared, widened;
  };
  /// Returns the squared gradient at the site with these indices in the box. value(axis, d) returns the value
  /// d sites away from it along an axis.
  template <class Value>
  [[nodiscard]] SquaredGradient squared_gradient_at(const Index& p, const Value& value) const {
    float sum = 0, wide = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (n_[a] < 2) continue;
      const bool first = p[a] == 0, last = p[a] + 1 == n_[a];
      const double before = first ? 0 : gaps_[a][p[a] - 1], behind = last ? 0 : gaps_[a][p[a]];
      const float g =
          (value(a, last ? 0 : 1) - value(a, first ? 0 : -1)) / static_cast<float>(before + behind);
      const auto half = static_cast<float>(0.5 * (before + behind));
      sum += g * g;
      wide += g * g * g * g * half * half;
    }
    return {sum, sum > 0 ? wide / sum / sum : 0};
  }
  /// Returns the indices in the box of a site that lies in it.
  [[nodiscard]] Index indices(std::size_t site) const {
    const Index p = sites_.indices(site);
    return {p[0] - low_[0], p[1] - low_[1], p[2] - low_[2]};
  }

  /// Computes the squared gradient of an array by central differences, one-sided on the domain's border;
  /// lengths are in the grid's unit. `widened`: the sum over axes of n^4 h^2, with the normal n and half the
  /// distance h of the two sites of a difference; a third of it is the error of central differences in the
  /// variance of a step.
  void squared_gradient(const std::vector<float>& values, std::vector<float>& squared,
                        std::vector<float>& widened) const;

  /// Spreads an array by diffusion to neighbours along each axis. `variance` is in the square of the unit of
  /// length. Nothing leaves the box. `scratch` is working memory.
  void diffuse(std::vector<float>& values, double variance, std::vector<float>& scratch) const {
    spread(values, variance, false, nullptr, 0, scratch);
    values.swap(scratch);
  }
  /// Does the same with the array `from`, which has been spread `steps` times; `to`, another array, becomes
  /// the result where it is needed. `needs`: null if all values are needed.
  void diffuse(const std::vector<float>& from, double variance, const DiffusionNeeds* needs,
               std::size_t steps, std::vector<float>& to) const {
    spread(from, variance, false, needs, steps, to);
  }
  /// Spreads an array by a variance that is in squares of the distance of sites along each axis, whatever
  /// that distance is.
  void blend(std::vector<float>& values, double variance, std::vector<float>& scratch) const;
  /// Marks all sites within `reach` sites of a marked one along each axis.
  void dilate(std::vector<std::uint8_t>& marks, int reach) const;
  /// Returns the greatest variance of one step of diffusion.
  [[nodiscard]] double greatest_step() const;

 private:
  /// The parts of the values of the neighbours before and behind each site along an axis that are added to
  /// its value.
  struct Shares {
    std::vector<float> before, behind;
  };
  [[nodiscard]] Shares shares(int axis, double variance, bool in_sites) const;
  /// Spreads an array; `to` is another one.
  void spread(const std::vector<float>& from, double variance, bool in_sites, const DiffusionNeeds* needs,
              std::size_t steps, std::vector<float>& to) const;

  const RectilinearGrid& grid_;
  GridSites sites_;
  Index low_, n_;
  std::array<std::vector<double>, 3> gaps_;  // the distances from each site to the next
};

}  // namespace adamas::interfaces
