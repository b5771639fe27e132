#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/lattice/diamond_type.h"
#include "isosurface/extraction/padded_grid.h"

namespace adamas {

/// A diamond that is split, as its members round the split vertex: the vertices of its tetrahedra and the
/// split vertex. Sets of members are bits in the order of the members.
struct DiamondStencil {
  using Members = std::uint32_t;
  static constexpr std::size_t kBegin = 0, kEnd = 1, kMiddle = 2, kRing = 3, kMost = kRing + 8;
  /// Edges between points on or one step round a page are numbered by the sums of their ends, counted from
  /// the least: in a grid of so many along each axis, i running fastest.
  static constexpr std::int32_t kEdgeSide = 2 * (PaddedGrid<int>::kSide - 1) + 1;

  static constexpr std::int32_t edge_place(LatticePoint sum) {
    return sum.i + kEdgeSide * (sum.j + kEdgeSide * sum.k);
  }

  /// A half of one of the tetrahedra.
  struct Half {
    std::uint8_t slot;                     ///< of the tetrahedron
    std::array<std::uint8_t, 4> vertices;  ///< members, in the child diamond's order
    Members members;                       ///< the same as a set
    /// `edge_place` of the edges, in the order of kTetrahedronEdges, from that of the split vertex with
    /// itself.
    std::array<std::int32_t, 6> edges;
  };

  int phase;
  std::size_t count;                        ///< of members
  std::array<LatticePoint, kMost> offsets;  ///< in units of the diamond's scale
  std::array<std::int32_t, kMost> places;   ///< the same in a PaddedGrid
  std::size_t tetrahedron_count;
  std::array<Members, 8> tetrahedra;  ///< by slot
  std::size_t child_count;
  /// In phase 2 in units of half the scale: children belong to the next finer LOD there.
  std::array<LatticePoint, 8> children;
  std::array<Half, 16> halves;  ///< two for each child
  /// By the members above a contour: the halves that it crosses, as bits; and how many triangles more it has
  /// in all of them than in the tetrahedra.
  std::vector<std::uint16_t> crossed;
  std::vector<std::int8_t> added;

  /// How many triangles a contour has in a tetrahedron with these vertices, of which those of `above` are
  /// above it.
  static int triangles(Members vertices, Members above) {
    const Members found = vertices & above;
    if (found == 0 || found == vertices) return 0;
    // Of four vertices two where one is left without the first, and none without the next: counting bits may
    // be a call.
    const Members others = found & (found - 1);
    return others != 0 && (others & (others - 1)) == 0 ? 2 : 1;
  }

  /// As bits.
  [[nodiscard]] unsigned all_slots() const { return (1u << tetrahedron_count) - 1; }

  /// `added` in the halves of these tetrahedra alone.
  [[nodiscard]] int added_in(unsigned slots, Members above) const;

  /// Of the type that points have whose coordinates, in units of the diamond's scale, end in the two lowest
  /// bits of those of q.
  static const DiamondStencil& at(LatticePoint q) {
    static const DiamondStencil* const kAll = all();
    return kAll[static_cast<std::size_t>(diamond_type(q, 0))];
  }

 private:
  /// Of all types.
  static const DiamondStencil* all();
};

}  // namespace adamas
