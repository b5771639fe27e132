#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// The connected groups of cells that hold more than kFractionTrace of a material; cells are connected by
/// faces, edges and corners. Cells that a material fills, with no other material near, are in no group.
class HeldCells {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// Finds the groups. The values must outlive this object.
  HeldCells(const MultiMaterialData& data, const SiteValues& values);

  /// Finds the entry of a material at a site, or of its region with the greatest fraction; null if the cell
  /// does not hold the material.
  [[nodiscard]] const SiteValues::Entry* find(std::size_t site, MaterialId material) const;
  /// Returns the group of a site's cell; kNone if the cell does not hold the material.
  [[nodiscard]] std::uint32_t group(std::size_t site, MaterialId material) const;
  [[nodiscard]] std::size_t group_count() const { return first_runs_.size() - 1; }
  [[nodiscard]] MaterialId material(std::uint32_t group) const {
    return runs_[runs_of_groups_[first_runs_[group]]].material;
  }
  /// Calls visit(site, fraction) for the cells of a group, in order, until it returns false; returns whether
  /// all were visited.
  template <class Visit>
  bool for_each_cell(std::uint32_t group, const Visit& visit) const {
    for (std::uint32_t n = first_runs_[group]; n < first_runs_[group + 1]; ++n) {
      const Run& run = runs_[runs_of_groups_[n]];
      for (std::size_t site = run.begin; site < run.end; ++site) {
        if (!visit(site, static_cast<double>(find(site, run.material)->fraction))) return false;
      }
    }
    return true;
  }

 private:
  /// Successive sites along x whose cells hold a material.
  struct Run {
    MaterialId material;
    std::uint32_t begin, end;
    std::uint32_t group = kNone;
    auto operator<=>(const Run&) const = default;
  };

  [[nodiscard]] std::vector<Run> runs_of_row(std::size_t first) const;
  void join_rows(std::size_t row, std::size_t other, DisjointSets& sets) const;
  void number_groups(const std::vector<std::uint32_t>& roots);

  const SiteValues& values_;
  std::size_t row_;        ///< the number of sites in a row
  std::vector<Run> runs_;  ///< by row, material and first site
  std::vector<std::uint32_t> first_of_row_;
  std::vector<std::uint32_t> first_runs_, runs_of_groups_;  ///< the runs of each group
};

}  // namespace adamas::interfaces
