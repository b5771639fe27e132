#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/data/multi_material_data.h"
#include "core/geometry/ownership_problem.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// The lattice cell, the tetrahedron and the weights of a point.
struct LatticeLocation {
  std::array<std::uint32_t, 3> cell;
  std::size_t path;
  Weights weights;
};
/// Locates a point in the lattice with these coordinates along the axes; points outside the domain are moved
/// to the nearest point inside.
LatticeLocation locate_in_lattice(const std::array<std::vector<double>, 3>& coordinates, const Vec3& p);

/// The values of materials as functions of space that are linear in tetrahedra (docs/method.md, Interfaces
/// from volume fractions): the points of the lattice are the sites of the data and, where sites are cell
/// centres, points on the domain's boundary with values continued linearly. Each lattice cell consists of six
/// tetrahedra round its main diagonal. A point belongs to the material with the greatest value; of equal
/// ones, to the one whose name comes first.
class MaterialLattice {
 public:
  /// The values must outlive the lattice and not change.
  MaterialLattice(const MultiMaterialData& data, const SiteValues& values);

  using Index = std::array<std::uint32_t, 3>;
  /// The paths of a lattice cell's tetrahedra from the lowest corner to the highest, as orders of the axes.
  static constexpr std::array<std::array<int, 3>, 6> kPaths{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};

  [[nodiscard]] std::uint32_t points(int axis) const {
    return static_cast<std::uint32_t>(coordinates_[static_cast<std::size_t>(axis)].size());
  }
  [[nodiscard]] std::uint32_t point_count() const { return points(0) * points(1) * points(2); }
  [[nodiscard]] std::uint32_t point_index(const Index& p) const {
    return p[0] + points(0) * (p[1] + points(1) * p[2]);
  }
  [[nodiscard]] Vec3 position(const Index& p) const {
    return {coordinates_[0][p[0]], coordinates_[1][p[1]], coordinates_[2][p[2]]};
  }
  /// Returns the site nearest to a lattice point; `grid` is that of the data.
  [[nodiscard]] std::size_t nearest_site(const RectilinearGrid& grid, const Index& p) const;
  /// The two points from which values are continued to a point on the border, and the distance from it to the
  /// nearest one relative to that between the two.
  struct Inwards {
    Index nearest, next;
    double step;
  };
  /// Returns these for a point on the border; none for a site, and where there is only one site along the
  /// axis. Values are continued along one axis after another, so that corners take theirs from edges.
  [[nodiscard]] std::optional<Inwards> inwards(const Index& p) const;
  [[nodiscard]] std::size_t material_count() const { return material_count_; }
  /// Returns the number, as in SiteValues, of the material or region with the greatest value at a lattice
  /// point.
  [[nodiscard]] std::uint16_t owner(std::uint32_t point) const { return owner_[point]; }
  [[nodiscard]] MaterialId material(std::uint32_t number) const { return by_name_[number]; }
  /// Returns whether two numbers of owners stand for one region: they are equal, or one of them is a material
  /// that has regions elsewhere, and the other one is its region.
  [[nodiscard]] bool is_one_region(std::uint32_t a, std::uint32_t b) const {
    return a == b || (whole_[a] == whole_[b] && (a == whole_[a] || b == whole_[b]));
  }
  /// Returns whether one region owns all corners of a tetrahedron, and so all of it.
  [[nodiscard]] bool have_one_owner(const std::array<std::uint32_t, 4>& corners) const;
  /// Marks the sites whose values ownership() may need: the corners of lattice cells with several owners.
  [[nodiscard]] std::vector<std::uint8_t> sites_beside_others() const;

  /// Returns the corners of a tetrahedron of a lattice cell, beginning with the lowest.
  [[nodiscard]] std::array<Index, 4> tetrahedron(const Index& cell, std::size_t path) const;
  /// Sets `problem` to the ownership problem of a tetrahedron whose corners have at least two owners;
  /// materials that are far from all corners are left out. Owners are numbers of materials and regions.
  void ownership(const std::array<Index, 4>& corners, OwnershipProblem& problem) const;
  using Location = LatticeLocation;
  [[nodiscard]] Location locate(const Vec3& p) const { return locate_in_lattice(coordinates_, p); }

 private:
  using Entry = SiteValues::Entry;

  [[nodiscard]] bool is_on_border(const Index& p) const;
  [[nodiscard]] Index indices(std::uint32_t point) const {
    return {point % points(0), point / points(0) % points(1), point / (points(0) * points(1))};
  }
  /// Returns the values at a point; none if one material fills it and all points round it.
  [[nodiscard]] std::span<const Entry> at(const Index& p) const;
  template <class Visit>
  void for_each_point(const Visit& visit) const;
  void add_border(const MultiMaterialData& data);
  void continue_along(std::size_t axis);
  void find_owners(const MultiMaterialData& data);
  [[nodiscard]] double value(std::span<const Entry> entries, std::uint16_t number) const;

  const SiteValues& values_;
  std::array<std::vector<double>, 3> coordinates_;
  std::array<std::uint32_t, 3> margin_{};  ///< 1 along an axis with extra boundary points
  std::size_t material_count_;
  std::vector<MaterialId> by_name_;   ///< by number
  std::vector<std::uint16_t> whole_;  ///< by number
  // The values at points on the border that are no sites.
  std::vector<std::uint32_t> border_;        ///< these points, ascending
  std::vector<std::uint32_t> border_first_;  ///< the index of the first value of each
  std::vector<Entry> border_entries_;
  double far_ = 0;
  std::vector<std::uint16_t> owner_;
};

}  // namespace adamas::interfaces
