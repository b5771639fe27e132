#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/data/multi_material_data.h"
#include "core/geometry/ownership_problem.h"
#include "interfaces/reconstruction/label_runs.h"
#include "interfaces/reconstruction/material_lattice.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/tetrahedron_shares.h"

namespace adamas::interfaces {

/// The lattice of MaterialLattice for labels. Values need no arrays: a material's value at a site is half of
/// the shortest side of the site's cell, positive if the site has its label, plus an offset of the material.
/// Values of smoothed labels are in SiteValues. Each site keeps its label, so that the owner of a lattice
/// point is the label of the nearest site. Materials have the numbers of SiteValues.
class LabelLattice {
 public:
  using Index = std::array<std::uint32_t, 3>;
  using Values = std::array<double, 4>;

  explicit LabelLattice(const MultiMaterialData& data);
  /// Takes the values of smoothed labels of the same data.
  LabelLattice(const MultiMaterialData& data, SiteValues&& smoothed);

  [[nodiscard]] const LabelRuns& runs() const { return runs_; }
  [[nodiscard]] std::uint32_t points(int axis) const {
    return static_cast<std::uint32_t>(coordinates_[static_cast<std::size_t>(axis)].size());
  }
  [[nodiscard]] std::size_t sites(std::size_t axis) const { return sites_[axis]; }
  [[nodiscard]] Vec3 position(const Index& p) const {
    return {coordinates_[0][p[0]], coordinates_[1][p[1]], coordinates_[2][p[2]]};
  }
  /// Returns the index along an axis of the site next to a lattice point.
  [[nodiscard]] std::uint32_t site(std::size_t axis, std::uint32_t point) const {
    return sites_of_[axis][point];
  }
  [[nodiscard]] std::size_t material_count() const { return by_name_.size(); }
  [[nodiscard]] MaterialId material(std::uint32_t number) const { return by_name_[number]; }
  /// Returns the number of the owner of a lattice point.
  [[nodiscard]] std::uint16_t owner(const Index& p) const {
    return number(sites_of_[0][p[0]], sites_of_[1][p[1]], sites_of_[2][p[2]]);
  }
  /// Returns the value of a material at a lattice point.
  [[nodiscard]] double value(const Index& p, std::uint16_t number) const { return value(p, number, nullptr); }

  /// Moves the values of materials by offsets, each between -most and most; smoothed values keep their signs.
  void shift(std::span<const double> offsets, double most);
  /// Returns the part of an offset by which the value of a material at a point moves.
  [[nodiscard]] double share(const Index& p, std::uint16_t number) const;
  /// Returns the same where the value of the material at the point is known.
  [[nodiscard]] double share(const Index& p, std::uint16_t number, double value) const {
    if (!smoothed_) return 1;
    if (is_at_border(0, p[0]) || is_at_border(1, p[1]) || is_at_border(2, p[2])) return share(p, number);
    return value != far_ && std::abs(value) > smoothed_->least_label_value() ? 1 : 0;
  }

  /// Returns whether nothing but the labels at the corners matters for a tetrahedron of a lattice cell:
  /// values at sites are the same everywhere but for round-off, no corner is at the border, and no other
  /// material owns a part.
  [[nodiscard]] bool is_plain(const Index& cell) const {
    return plain_ && cell[0] > 0 && cell[1] > 0 && cell[2] > 0 && cell[0] + 2 < points(0) &&
           cell[1] + 2 < points(1) && cell[2] + 2 < points(2);
  }
  /// Returns whether is_plain() holds for all cells but those at the border, and all these are equal.
  [[nodiscard]] bool has_equal_cells() const { return plain_ && equal_cells_; }
  /// Return the values of a material at the corners of cells that are plain, with its label and without.
  [[nodiscard]] double inside(std::uint16_t number) const { return inside_[number]; }
  [[nodiscard]] double outside(std::uint16_t number) const { return outside_[number]; }

  /// The corners of a tetrahedron and the numbers of their owners.
  struct Tetrahedron {
    std::array<Index, 4> corners;
    std::array<std::uint16_t, 4> owners;
  };
  [[nodiscard]] static Tetrahedron tetrahedron(const Index& cell, std::size_t path,
                                               const std::array<std::uint16_t, 4>& owners);
  [[nodiscard]] Tetrahedron tetrahedron(const Index& cell, std::size_t path) const;
  /// The materials with values at the corners of a cell, ascending by number. Corners are numbered by bits:
  /// 1, 2 and 4 for the greater index along x, y and z.
  struct CellMaterial {
    std::uint16_t number;
    std::uint8_t near;  ///< bits of the corners where the material has a value
    std::array<double, 8> values;
  };
  using CellMaterials = std::vector<CellMaterial>;
  void find_materials(const Index& cell, CellMaterials& found) const;
  using Candidate = CornerValues;
  /// Finds the materials that may own a part of a tetrahedron whose corners have several owners, ascending by
  /// number. If two materials own the corners, others are left out that are surely below one of them.
  /// `corners`: the numbers of its corners in the cell.
  void find_candidates(const CellMaterials& cell, const std::array<std::uint8_t, 4>& corners,
                       const std::array<std::uint16_t, 4>& owners, std::vector<Candidate>& found) const;
  void find_candidates(const Index& cell, std::size_t path, const std::array<std::uint16_t, 4>& owners,
                       std::vector<Candidate>& found) const;
  /// Finds the materials that own the corners of a tetrahedron in a plain cell.
  void find_owners(const std::array<std::uint16_t, 4>& owners, std::vector<Candidate>& found) const;
  /// Returns the corners of the tetrahedra in their cells.
  [[nodiscard]] static std::array<std::uint8_t, 4> cell_corners(std::size_t path);
  /// Sets `problem` to the ownership problem of a tetrahedron.
  static void set_problem(std::span<const Candidate> candidates, OwnershipProblem& problem);

  /// Locates a point; points outside the domain are moved to the nearest point inside.
  [[nodiscard]] LatticeLocation locate(const Vec3& p) const { return locate_in_lattice(coordinates_, p); }

  /// Returns whether the sides of sites' cells differ by a factor of two at most, but for rounded
  /// coordinates.
  [[nodiscard]] bool has_even_spacing() const { return even_spacing_; }
  /// Calls mixed(i, runs) for the cells of a row along x, from `first` to before `last`, whose corners have
  /// several owners, with the runs of the corners, and uniform(begin, end, number) for stretches of others.
  template <class Mixed, class Uniform>
  void for_each_cell(std::uint32_t j, std::uint32_t k, std::uint32_t first, std::uint32_t last, Mixed&& mixed,
                     Uniform&& uniform) const;
  /// Whether all sites keep their labels under the offsets.
  [[nodiscard]] bool labels_stay() const;

 private:
  [[nodiscard]] std::uint16_t number(std::size_t i, std::size_t j, std::size_t k) const {
    return runs_.number(runs_.find(i, j + sites_[1] * k));
  }
  void set_geometry(const MultiMaterialData& data);
  void update_plain();
  [[nodiscard]] double half_side(const Index& site) const {
    return 0.5 * std::min({sides_[0][site[0]], sides_[1][site[1]], sides_[2][site[2]]});
  }
  [[nodiscard]] double moved(double value, std::uint16_t number) const {
    for (const double offset : offsets_[number]) value += offset;
    return value;
  }
  [[nodiscard]] Index nearest_site(const Index& p) const {
    return {sites_of_[0][p[0]], sites_of_[1][p[1]], sites_of_[2][p[2]]};
  }
  [[nodiscard]] bool is_at_border(std::size_t axis, std::uint32_t p) const {
    return margin_[axis] != 0 && (p == 0 || p + 1 == coordinates_[axis].size());
  }
  /// The two points beside one at the border along an axis, the nearer first, and the step from the second
  /// over the first to it.
  struct Inwards {
    Index one, two;
    double step;
  };
  [[nodiscard]] Inwards inwards(const Index& p, std::size_t axis) const;
  [[nodiscard]] std::size_t site_index(const Index& s) const {
    return s[0] + sites_[0] * (s[1] + sites_[1] * std::size_t{s[2]});
  }
  /// The numbers of the labels of some sites; rows of four along x.
  struct Block {
    Index low;
    std::array<std::array<std::array<std::uint16_t, 4>, 4>, 4> numbers;

    [[nodiscard]] std::uint16_t at(const Index& site) const {
      return numbers[site[2] - low[2]][site[1] - low[1]][site[0] - low[0]];
    }
  };
  [[nodiscard]] double value(const Index& p, std::uint16_t number, const Block* block) const;
  [[nodiscard]] double site_value(const Index& site, std::uint16_t number, const Block* block) const;
  [[nodiscard]] bool is_near(const Index& site, std::uint16_t number, const Block* block) const;
  [[nodiscard]] Block block_round(const Index& low, const Index& high) const;
  template <class Add>
  void for_each_near(const Index& site, const Block& block, Add&& add) const;

  std::array<std::vector<double>, 3> coordinates_, sides_;
  std::array<std::vector<std::uint32_t>, 3> sites_of_;
  std::array<std::uint32_t, 3> margin_{};
  std::array<std::size_t, 3> sites_{};
  std::array<std::array<double, 2>, 3> steps_{};  ///< by axis and end: the step of continued values
  std::vector<MaterialId> by_name_;
  LabelRuns runs_;
  double far_ = 0;
  double half_ = 0;        ///< half of the shortest side of a site's cell away from the border
  double least_half_ = 0;  ///< that of the smallest one
  std::vector<std::vector<double>> offsets_;  ///< by number: the offsets one after another
  std::vector<double> inside_, outside_;
  bool equal_sites_ = false, equal_cells_ = false;  ///< but for round-off, away from the border
  bool even_spacing_ = true;
  bool plain_ = false;
  std::optional<SiteValues> smoothed_;
};

template <class Mixed, class Uniform>
void LabelLattice::for_each_cell(std::uint32_t j, std::uint32_t k, std::uint32_t first, std::uint32_t last,
                                 Mixed&& mixed, Uniform&& uniform) const {
  std::array<std::uint32_t, 4> run{}, behind{}, end{};
  for (std::uint32_t r = 0; r < 4; ++r) {
    const std::size_t row = sites_of_[1][j + (r & 1u)] + sites_[1] * std::size_t{sites_of_[2][k + (r >> 1)]};
    run[r] = runs_.find(sites_of_[0][first], row);
    behind[r] = runs_.first_of_row(row + 1);
    end[r] = runs_.end(run[r], behind[r]);
  }
  std::array<std::uint32_t, 8> corners{};
  for (std::uint32_t i = first; i < last;) {
    const std::uint32_t site = sites_of_[0][i], next = sites_of_[0][i + 1];
    for (std::uint32_t r = 0; r < 4; ++r) {
      if (end[r] <= site) end[r] = runs_.end(++run[r], behind[r]);
    }
    const std::uint16_t number = runs_.number(run[0]);
    const std::uint32_t change = std::min({end[0], end[1], end[2], end[3]});
    if (next < change && runs_.number(run[1]) == number && runs_.number(run[2]) == number &&
        runs_.number(run[3]) == number) {
      // The cell before the first one that has a corner at the change, or all that are left.
      const std::uint32_t stop = change < sites_[0] ? std::min(last, change + margin_[0] - 1) : last;
      uniform(i, stop, number);
      i = stop;
      continue;
    }
    for (std::uint32_t r = 0; r < 4; ++r) {
      corners[2 * r] = run[r];
      corners[2 * r + 1] = end[r] <= next ? run[r] + 1 : run[r];
    }
    mixed(i, corners);
    ++i;
  }
}

}  // namespace adamas::interfaces
