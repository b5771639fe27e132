#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/data/multi_material_data.h"
#include "core/geometry/partition.h"

namespace adamas {

/// Volume fractions as a function of space that is linear in tetrahedra (docs/method.md, Interfaces from
/// volume fractions): the points of the lattice are the sites of the data and, where sites are cell centres,
/// points on the domain's boundary with values extrapolated linearly and normalised. Each lattice cell is six
/// tetrahedra round its main diagonal. A point belongs to the material with the greatest fraction, ties to
/// the one whose name comes first.
class FractionLattice {
 public:
  explicit FractionLattice(const MultiMaterialData& data);

  using Index = std::array<std::uint32_t, 3>;
  /// The path of a tetrahedron of a lattice cell from its lowest corner to its highest: the order of the
  /// axes.
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
  [[nodiscard]] std::size_t material_count() const { return rank_.size(); }
  /// Fraction of a material at a lattice point.
  [[nodiscard]] float fraction(MaterialId m, std::uint32_t point) const {
    return !of_labels_ ? fractions_[m][point] : (owner_[point] == m.value ? 1.0f : 0.0f);
  }
  /// Material with the greatest fraction at a lattice point.
  [[nodiscard]] MaterialId owner(std::uint32_t point) const { return MaterialId(owner_[point]); }
  /// Whether one material has the fraction 1 there.
  [[nodiscard]] bool pure(std::uint32_t point) const { return of_labels_ || pure_[point]; }

  /// Corners of a tetrahedron of the lattice cell at `cell`, from the lowest on.
  [[nodiscard]] std::array<Index, 4> tetrahedron(const Index& cell, std::size_t path) const;
  /// Who owns what of a tetrahedron; materials without any fraction at its corners are left out. Owners are
  /// materials.
  void ownership(const std::array<std::uint32_t, 4>& corners, OwnershipProblem& problem) const;
  /// The lattice cell, the tetrahedron and the weights of a point; points outside the domain count as the
  /// nearest inside.
  struct Location {
    Index cell;
    std::size_t path;
    Weights weights;
  };
  [[nodiscard]] Location locate(const Vec3& p) const;

 private:
  void extend(const MultiMaterialData& data);
  void normalise();
  void find_owners();

  std::array<std::vector<double>, 3> coordinates_;
  std::array<std::uint32_t, 3> margin_{};     ///< 1 along an axis with extra boundary points
  IdVector<MaterialId, std::uint32_t> rank_;  ///< position in the order of names
  IdVector<MaterialId, std::vector<float>> fractions_;
  bool of_labels_ = false;
  std::vector<std::uint16_t> owner_;
  std::vector<bool> pure_;
};

}  // namespace adamas
