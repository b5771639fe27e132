#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/grid_data.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/reconstruction/grid_sites.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// A cell is counted as off if a volume differs from its fraction by more than this, relative to the cell's
/// volume.
inline constexpr double kCellOff = 1e-3;

/// Computes the exact volumes of materials in the cell of one site after another, and their derivatives with
/// respect to the values at the sites round it. The materials are those that have a value at the site, in the
/// order of their numbers. Each has a row of values, or several rows if it has regions near the site.
class CellVolumes {
 public:
  CellVolumes(const RectilinearGrid& grid, const SiteValues& values, const SiteCells& cells);

  /// The derivatives of the volume that the first of two rows of different materials takes from the second
  /// one, with respect to the first row's values at the site and its neighbours. Those with respect to the
  /// second row's values have the other sign.
  struct Pair {
    std::size_t first, second;
    std::array<double, SiteCell::kNeighbours> growth;
  };
  struct Material {
    std::uint16_t number;
    double fraction;
  };

  /// Looks up the values round a site.
  void set_site(std::size_t site);
  [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
  /// Returns the index of a row's material in materials().
  [[nodiscard]] std::size_t material_of(std::size_t row) const { return materials_of_rows_[row]; }
  /// Stores the site's values for move_values().
  void store_values();
  /// Sets the site's values of a material, in this object only, to the stored ones plus `by`, but no farther
  /// than `most` from zero. Values of regions that hold nothing of the material here do not change.
  void move_values(std::size_t m, double by, double most);
  /// Returns the volumes relative to the cell's volume; with `growth`, pairs() is computed as well.
  const std::vector<double>& measure(bool growth = false);
  /// Returns the greatest difference between the volumes measured last and the fractions.
  [[nodiscard]] double greatest_difference() const;
  [[nodiscard]] const std::vector<Pair>& pairs() const { return pairs_; }
  /// Returns the index in SiteValues::entries() of a row's value at the n-th neighbour; kNone if there is
  /// none.
  [[nodiscard]] std::uint32_t entry(std::size_t row, std::size_t n) const { return entries_[row][n]; }
  [[nodiscard]] std::size_t rows() const { return count_; }
  /// Returns a row's value at the site, including the moves of move_values().
  [[nodiscard]] double value_at_site(std::size_t row) const { return values_round_[row][SiteCell::kSelf]; }
  static constexpr std::uint32_t kNone = 0xffffffffu;

 private:
  using Values = std::array<double, 4>;
  using NeighbourSet = std::bitset<SiteCell::kNeighbours>;

  void find_neighbours(std::size_t site);
  [[nodiscard]] bool has_the_same_materials(std::span<const SiteValues::Entry> there) const;
  void set_values_inside();
  void find_rows(std::size_t site);
  template <class Visit>
  void for_each_border(Visit&& visit) const;
  void extend();
  void fold(std::array<double, SiteCell::kNeighbours>& round) const;
  [[nodiscard]] double border_step(int axis, bool high) const;
  void measure_rows();
  void find_contenders();
  template <bool kGrowth>
  void measure_two(std::size_t m, std::size_t n);
  void find_nodes();
  void measure_part(const SiteCell::Part& part);
  void share(const SiteCell::Part& part);
  void share_between_two(const SiteCell::Part& part, std::size_t m, std::size_t n);
  void share_between_all(const SiteCell::Part& part);
  void drop_contenders_without_part(const SiteCell::Part& part);
  template <bool kGrowth>
  PositivePart first_of_two(const SiteCell::Part& part, std::size_t m, std::size_t n);
  void add_growth(const SiteCell::Part& part, std::size_t m, std::size_t n, const Values& growth);
  [[nodiscard]] Values at_corners(const SiteCell::Part& part, std::size_t m) const {
    const auto& row = values_at_nodes_[m];
    return {row[part.nodes[0]], row[part.nodes[1]], row[part.nodes[2]], row[part.nodes[3]]};
  }
  [[nodiscard]] Values difference(const SiteCell::Part& part, std::size_t m, std::size_t n) const {
    Values d = at_corners(part, m);
    const Values other = at_corners(part, n);
    for (std::size_t c = 0; c < 4; ++c) d[c] -= other[c];
    return d;
  }

  const RectilinearGrid& grid_;
  GridSites grid_sites_;
  const SiteValues& values_;
  const SiteCells& cells_;
  static constexpr std::size_t kNoSite = std::numeric_limits<std::size_t>::max();
  std::array<std::size_t, 3> place_{};
  std::array<std::size_t, SiteCell::kNeighbours> neighbours_;  // kNoSite beyond the grid
  std::array<std::ptrdiff_t, SiteCell::kNeighbours>
      offsets_{};  // of the numbers of neighbours from the site's
  const SiteCell* cell_ = nullptr;
  SiteCell scratch_;
  std::size_t count_ = 0;
  bool is_inside_ = false;  // whether the site has all neighbours
  bool at_border_ = false, with_growth_ = false;
  std::vector<std::array<double, SiteCell::kNeighbours>> values_round_;  // by material
  // By row: whether the material is pure at the nearest site. These sets are only kept up at the border and
  // where there are regions.
  std::vector<NeighbourSet> is_pure_;
  // by row: whether a region's value is that of its whole material, because the material has no regions at
  // the nearest site.
  std::vector<NeighbourSet> is_whole_value_;
  std::vector<std::array<std::uint32_t, SiteCell::kNeighbours>> entries_;
  std::vector<std::vector<double>> values_at_nodes_;  // by material
  std::vector<std::size_t> node_owners_;
  std::vector<double> differences_at_nodes_, growth_at_nodes_;  // used if two rows share the cell
  std::vector<std::uint8_t> is_positive_;
  std::vector<double> volumes_;           // by row
  std::vector<double> material_volumes_;  // by material; used if there are more rows than materials
  std::vector<Material> materials_;
  std::vector<std::uint16_t> numbers_;          // by row: the number of SiteValues
  std::vector<std::size_t> materials_of_rows_;  // by row
  std::vector<double> stored_values_;           // by row
  std::vector<Pair> pairs_;
  std::vector<std::size_t> contenders_;
  std::vector<TetrahedronPiece> pieces_, scratch_pieces_;
};

}  // namespace adamas::interfaces
