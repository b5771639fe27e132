#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Groups of cells that hold a material, more than kFractionTrace of it, and hang together by faces, edges
/// and corners. Cells that a material fills without others near are in none.
class HeldCells {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// The data and the values must outlive this object.
  HeldCells(const MultiMaterialData& data, const SiteValues& values);

  /// The entry of a material at a site, or that of its regions which has the greatest part; null where the
  /// cell does not hold it.
  [[nodiscard]] const SiteValues::Entry* find(std::size_t site, MaterialId material) const;
  /// The group of a site's cell; kNone where it holds nothing of the material, or is not yet collected.
  [[nodiscard]] std::uint32_t group(std::size_t site, MaterialId material) const;
  /// Gathers the group of a cell that holds the material and is in none yet: sites with their fractions, the
  /// given one first; replaces `cells`. Groups are numbered in the order of the calls.
  void collect(std::size_t site, MaterialId material, std::vector<std::pair<std::size_t, double>>& cells);

 private:
  [[nodiscard]] std::size_t index(const SiteValues::Entry* entry) const { return values_.index(*entry); }

  GridSites sites_;
  const SiteValues& values_;
  std::vector<std::uint32_t> group_of_;  ///< by entry
  std::uint32_t groups_ = 0;
};

}  // namespace adamas::interfaces
