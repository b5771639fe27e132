#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "adamas/grid_data.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Finds the cells that a single material or region owns because its value is the greatest at the site and at
/// all sites round it. CellVolumes would find the volume 1 for it there and 0 for all others, at more
/// expense.
class SoleOwners {
 public:
  static constexpr std::uint16_t kNone = 0xffffu;

  /// Looks up the present values. The grid and the values must outlive this object.
  SoleOwners(const RectilinearGrid& grid, const SiteValues& values);

  /// Returns the number of the material or region that owns all of the cell of a site with values; kNone if
  /// the cell must be measured. Cells at the grid's sides must always be measured.
  [[nodiscard]] std::uint16_t owner(std::size_t site) const;
  /// Returns the greatest difference between volumes and fractions in a cell with this owner, as
  /// CellVolumes::greatest_difference() does.
  [[nodiscard]] double greatest_difference(std::size_t site, std::uint16_t owner) const;

 private:
  static constexpr std::uint16_t kEmpty = 0xfffeu;  ///< stands for a site without values

  void find_greatest(std::size_t site);

  GridSites sites_;
  const SiteValues& values_;
  std::array<std::size_t, 3> n_;
  std::vector<std::uint16_t>
      greatest_;  // by site: the number with the greatest value; kNone if there are several
  std::vector<std::uint8_t>
      has_region_;  // by site: whether a region has a value there; empty without regions
};

}  // namespace adamas::interfaces
