#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include "core/lattice/diamond.h"
#include "core/lattice/domain.h"

namespace adamas::test {

/// Returns whether a point is the corner of one of the domain's root cubes. All other points of the domain
/// are the split vertices of diamonds.
inline bool is_root_corner(const Domain& domain, LatticePoint p) {
  return domain.contains(p) && trailing_zeros(p) >= kRootBits;
}

/// Checks the laws of a mesh of tetrahedra that diamonds are split into (D 2): positive orientation, no
/// vertex of a neighbour inside an edge, and integer volumes that add up to the domain's. Tetrahedra are
/// added one by one.
class MeshLaws {
 public:
  using Corners = std::array<LatticePoint, 4>;

  /// `is_split` returns whether the diamond at a lattice point is split.
  MeshLaws(const Domain& domain, std::function<bool(LatticePoint)> is_split)
      : domain_(domain), is_split_(std::move(is_split)) {}

  /// Adds one of the tetrahedra of a diamond. Throws std::logic_error that names the law it breaks.
  void add(const Diamond& diamond, const Corners& corners);
  /// Checks the sum of the volumes, after the last tetrahedron; throws std::logic_error.
  void check_volume() const;

 private:
  const Domain& domain_;
  std::function<bool(LatticePoint)> is_split_;
  std::array<std::int64_t, kRootBits> volumes_{};  ///< per level, in units of that level's scale cubed
};

/// Mixes the bits of a word so that all of them are as good as random; it is invertible, like mix64
/// (Stafford's mixer 1).
constexpr std::uint64_t mix64_variant1(std::uint64_t z) {
  z = (z ^ (z >> 31)) * 0x7fb5d329728ea185;
  z = (z ^ (z >> 27)) * 0x81dadef4bc2dd44d;
  return z ^ (z >> 33);
}

/// Returns a checksum of a tetrahedron that does not depend on the order of its corners. Sums of such
/// checksums distinguish meshes, whatever the order of their tetrahedra.
std::uint64_t tetrahedron_checksum(std::array<LatticePoint, 4> corners);

}  // namespace adamas::test
