#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/data/mesh_data.h"
#include "interfaces/mesh_reconstruction/mesh_subdivision.h"
#include "interfaces/reconstruction/tetrahedron_shares.h"

namespace adamas::interfaces {

/// The variance of places in a cube along any direction, in relation to the square of its side.
inline constexpr double kCellVariance = 1.0 / 12;

/// The values of materials at the centres of cells, sparse: each cell has entries for the materials that it
/// or a cell near it holds. A point of the subdivision belongs to the material with the greatest value there;
/// of equal ones, to the one whose name comes first.
class MeshValues {
 public:
  using Index = MeshSubdivision::Index;
  struct Entry {
    std::uint16_t material;  ///< its number in the order of names
    float fraction;
    double value;  ///< a signed distance, positive inside the material
  };

  /// Finds the entries; values are not set. The subdivision must outlive this object.
  MeshValues(const MeshData& data, const MeshSubdivision& subdivision);

  /// Finds the entries again, after fractions have become 0. Values are not kept.
  void drop_absent();

  /// Finds the entries again, after regions of materials got numbers of their own: those after the present
  /// ones, of these materials. `held`: by cell, numbers with the fractions that it holds. Values are not
  /// kept.
  void divide(const std::vector<MaterialId>& added,
              const std::vector<std::vector<std::pair<std::uint16_t, float>>>& held);

  [[nodiscard]] const MeshSubdivision& subdivision() const { return subdivision_; }
  /// The material with a number; several numbers are regions of one material after divide().
  [[nodiscard]] MaterialId material(std::uint16_t number) const { return by_name_[number]; }
  /// The number of numbers.
  [[nodiscard]] std::size_t material_count() const { return by_name_.size(); }
  /// The first number of a material, one of whose numbers this is.
  [[nodiscard]] std::uint16_t whole(std::uint16_t number) const { return wholes_[number]; }
  /// Whether a number is that of one of several regions of its material.
  [[nodiscard]] bool is_part(std::uint16_t number) const { return is_part_[number] != 0; }
  [[nodiscard]] std::span<Entry> at(std::size_t cell) {
    return std::span(entries_).subspan(first_entries_[cell], first_entries_[cell + 1] - first_entries_[cell]);
  }
  [[nodiscard]] std::span<const Entry> at(std::size_t cell) const {
    return std::span(entries_).subspan(first_entries_[cell], first_entries_[cell + 1] - first_entries_[cell]);
  }
  /// The cells with entries of several materials, ascending.
  [[nodiscard]] const std::vector<Index>& active_cells() const { return active_; }
  /// The number of the one material of a cell without several entries.
  [[nodiscard]] std::uint16_t sole(std::size_t cell) const { return at(cell)[0].material; }
  /// The size of a cube with the volume of a cell.
  [[nodiscard]] double size(std::size_t cell) const;
  /// The extent of a cell along a direction of unit length: that of a box with the same second moment.
  [[nodiscard]] double extent(Index cell, const Vec3& direction) const;

  /// Computes the values at the points of active cells from those at cell centres.
  void interpolate();
  /// Returns the number of the material with the greatest value at a point of an active cell.
  [[nodiscard]] std::uint16_t owner(Index point) const;
  /// Returns the number of the one material with the greatest value at all points of an active cell; none if
  /// there are several.
  [[nodiscard]] std::optional<std::uint16_t> sole_owner(Index cell) const;
  /// Calls visit(cell, weight) for the cells whose values determine that of a material at a point of an
  /// active cell; for none where the material has no value there.
  template <class Visit>
  void for_each_source(Index point, std::uint16_t material, Visit&& visit) const {
    if (point >= place_of_point_.size()) {
      visit(static_cast<Index>(point - place_of_point_.size()), 1.0);
      return;
    }
    const std::span<const PointEntry> own = at_point(point);
    if (std::ranges::find(own, material, &PointEntry::material) == own.end()) return;
    const auto& [cells, weights] = stencils_[place_of_point_[point]];
    for (std::size_t i = 0; i < cells.size(); ++i) visit(cells[i], weights[i]);
  }
  /// Finds the materials that may own a part of a tetrahedron of an active cell, ascending by number.
  void find_materials(const std::array<Index, 4>& corners, std::vector<CornerValues>& found) const;

 private:
  struct PointEntry {
    std::uint16_t material;
    double value;
  };
  struct Held {
    std::uint16_t material;
    float fraction;
  };
  void find_entries(const std::vector<std::vector<Held>>& held);
  void find_points();
  [[nodiscard]] std::span<const PointEntry> at_point(Index point) const;
  template <class Entries>
  [[nodiscard]] static std::uint16_t greatest(const Entries& entries);

  const MeshSubdivision& subdivision_;
  std::vector<MaterialId> by_name_;    ///< by number
  std::vector<std::uint16_t> wholes_;  ///< in the same way
  std::vector<char> is_part_;          ///< in the same way
  std::vector<std::uint32_t> first_entries_;
  std::vector<Entry> entries_;
  std::vector<Index> active_;
  double far_ = 0;

  /// The points of active cells that are no centres of cells, ascending, with stencils and values.
  std::vector<Index> points_;
  std::vector<MeshSubdivision::Stencil> stencils_;
  std::vector<std::uint32_t> first_of_point_;
  std::vector<PointEntry> of_points_;
  std::vector<std::uint16_t> owners_;          ///< of these points
  std::vector<std::uint32_t> place_of_point_;  ///< by point: its place in points_, or kNone
};

/// Returns the number of each active cell's first entry among the entries of active cells, and the count of
/// these at the end.
std::vector<std::uint32_t> first_active_entries(const MeshValues& values);

/// Returns the place, among a cell's entries, of the first one of the material one of whose numbers is given;
/// their count if there is none.
inline std::size_t first_of_material(const MeshValues& values, std::span<const MeshValues::Entry> entries,
                                     std::uint16_t number) {
  const auto found = std::ranges::find_if(entries, [&](const MeshValues::Entry& entry) {
    return values.whole(entry.material) == values.whole(number);
  });
  return static_cast<std::size_t>(found - entries.begin());
}

}  // namespace adamas::interfaces
