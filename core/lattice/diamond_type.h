#pragma once

#include <array>
#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace adamas::inline core {

inline constexpr int kDiamondTypeCount = 26;

/// The common properties of all diamonds with one direction of the split edge (D 2): 8 types of phase 0, 12
/// of phase 1 and 6 of phase 2, in this order. Offsets are from the split vertex, in units of the diamond's
/// scale s unless said otherwise. Numbers are those of a diamond inside the domain.
struct DiamondType {
  /// One of the two or fewer tetrahedra that a split gives to a child diamond.
  struct ChildTetrahedron {
    std::uint8_t slot;        ///< number of the diamond's tetrahedron that is bisected
    std::uint8_t end;         ///< 0: the half with the end p - s d, 1: the half with p + s d
    std::uint8_t child_slot;  ///< number of the half among the child diamond's tetrahedra
    /// Its vertices in the child's order: 0 to 3 are the parent's vertices, 4 is the split vertex.
    std::array<std::uint8_t, 4> vertices;
  };

  int phase;
  LatticePoint direction;  ///< d: the split edge runs from p - s d to p + s d
  int tetrahedron_count, child_count, parent_count;
  /// The vertices round the split edge. Tetrahedron `slot` is (p - s d, p + s d, ring[slot], ring[slot + 1]),
  /// the ring being closed, and positively oriented.
  std::array<LatticePoint, 8> ring;
  std::array<LatticePoint, 4> parent_offsets;
  std::array<LatticePoint, 8> child_offsets;  ///< in units of s / 2
  std::array<std::uint8_t, 8> child_types;
  std::array<std::array<ChildTetrahedron, 2>, 8> child_tetrahedra;  ///< entries per child
};

/// The 26 types, computed from the geometry by the compiler.
extern const std::array<DiamondType, kDiamondTypeCount> kDiamondTypes;

/// The direction d of the split edge that follows from the two lowest bits of each coordinate of q = p >> t.
constexpr LatticePoint split_direction(LatticePoint q) {
  LatticePoint d{};
  for (int axis = 0; axis < 3; ++axis) d[axis] = (q[axis] & 1) == 0 ? 0 : (q[axis] & 3) == 1 ? 1 : -1;
  return d;
}

/// Directions of the types, in order of phase, then lexicographically.
constexpr std::array<LatticePoint, kDiamondTypeCount> diamond_directions() {
  std::array<LatticePoint, kDiamondTypeCount> directions{};
  std::size_t count = 0;
  for (int phase = 0; phase < 3; ++phase) {
    for (int code = 0; code < 27; ++code) {
      const LatticePoint d{code / 9 - 1, code / 3 % 3 - 1, code % 3 - 1};
      if (d.i * d.i + d.j * d.j + d.k * d.k == 3 - phase) directions[count++] = d;
    }
  }
  return directions;
}

/// Types by the two lowest bits of q: index (q.i & 3) << 4 | (q.j & 3) << 2 | (q.k & 3); kDiamondTypeCount
/// where all coordinates are even.
constexpr std::array<std::uint8_t, 64> diamond_types_by_bits() {
  constexpr auto kDirections = diamond_directions();
  std::array<std::uint8_t, 64> types{};
  for (int bits = 0; bits < 64; ++bits) {
    const LatticePoint d = split_direction({bits >> 4, bits >> 2, bits});
    std::uint8_t type = 0;
    while (type < kDiamondTypeCount && kDirections[type] != d) ++type;
    types[static_cast<std::size_t>(bits)] = type;
  }
  return types;
}
inline constexpr std::array<std::uint8_t, 64> kDiamondTypesByBits = diamond_types_by_bits();

/// Type of the diamond split at p, whose scale is 2^t.
constexpr int diamond_type(LatticePoint p, int t) {
  const int index = ((p.i >> t) & 3) << 4 | ((p.j >> t) & 3) << 2 | ((p.k >> t) & 3);
  return kDiamondTypesByBits[static_cast<std::size_t>(index)];
}

}  // namespace adamas::inline core
