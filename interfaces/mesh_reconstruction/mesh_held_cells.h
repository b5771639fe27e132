#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// The connected groups of cells that hold more than kFractionTrace of a material, or of those of these that
/// are chosen; cells are connected by points. Cells that a material fills, with no other material near, are
/// in no group. Regions of a material belong together.
class MeshHeldCells {
 public:
  using Index = MeshSubdivision::Index;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// An entry, of a cell, of a group's material.
  struct Place {
    std::uint32_t n;      ///< the cell's place among active ones
    std::uint32_t entry;  ///< among those of the cell
  };

  /// Finds the groups. `chooses`: whether an entry counts; null if all do. The values must outlive this
  /// object.
  explicit MeshHeldCells(const MeshValues& values, const std::function<bool(const Place&)>& chooses = {});

  /// The places of each group, ascending. Groups are in the order of their first places.
  [[nodiscard]] std::size_t group_count() const { return first_places_.size() - 1; }
  [[nodiscard]] std::span<const Place> places(std::uint32_t group) const {
    return std::span(places_).subspan(first_places_[group], first_places_[group + 1] - first_places_[group]);
  }
  /// Returns the group of a material, by its number, in a cell; kNone if the cell is in none.
  [[nodiscard]] std::uint32_t group(Index cell, std::uint16_t material) const;

 private:
  const MeshValues& values_;
  std::vector<std::uint32_t> place_of_cell_;  // among active cells, or kNone
  std::vector<std::uint32_t> firsts_;         // by active cell: its first entry, and the end
  std::vector<std::uint32_t> group_;          // by entry of active cells
  std::vector<std::uint32_t> first_places_;
  std::vector<Place> places_;
};

}  // namespace adamas::interfaces
