#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Finds the connected groups of cells that hold more than kFractionTrace of a material; cells are connected
/// by faces, edges and corners. Cells that a material fills, with no other material near, are in no group.
class HeldCells {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// The data and the values must outlive this object.
  HeldCells(const MultiMaterialData& data, const SiteValues& values);

  /// Finds the entry of a material at a site, or of its region with the greatest fraction; null if the cell
  /// does not hold the material.
  [[nodiscard]] const SiteValues::Entry* find(std::size_t site, MaterialId material) const;
  /// Returns the group of a site's cell; kNone if the cell does not hold the material or its group is not yet
  /// collected.
  [[nodiscard]] std::uint32_t group(std::size_t site, MaterialId material) const;
  /// Collects the group of a cell that holds the material and is in no group yet. `cells` becomes its sites
  /// with their fractions, the given site first. Groups are numbered in the order of the calls.
  void collect(std::size_t site, MaterialId material, std::vector<std::pair<std::size_t, double>>& cells);

 private:
  [[nodiscard]] std::size_t index(const SiteValues::Entry* entry) const { return values_.index(*entry); }

  GridSites sites_;
  const SiteValues& values_;
  std::vector<std::uint32_t> group_of_;  ///< by entry
  std::uint32_t groups_ = 0;
};

}  // namespace adamas::interfaces
