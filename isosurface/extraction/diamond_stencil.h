#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/lattice/diamond_type.h"
#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// Numbers of a page's points and of those one step round the page, so that points at its border have all
/// their neighbours: coordinates from -1 to 16, i running fastest.
template <class T>
class PaddedGrid {
 public:
  static constexpr std::ptrdiff_t kSide = 18;
  static constexpr std::size_t kPoints = kSide * kSide * kSide;

  [[nodiscard]] const T* at(LatticePoint q) const { return numbers_.data() + place(q); }
  [[nodiscard]] T* at(LatticePoint q) { return numbers_.data() + place(q); }
  /// The place of a point in any grid.
  static constexpr std::size_t place(LatticePoint q) {
    return static_cast<std::size_t>(offset({q.i + 1, q.j + 1, q.k + 1}));
  }
  /// The number that a step adds to places.
  static constexpr std::ptrdiff_t offset(LatticePoint d) { return d.i + kSide * (d.j + kSide * d.k); }

 private:
  std::array<T, kPoints> numbers_;
};

/// A type of diamonds that are split, as tables for contours in their halves. A diamond's members are the
/// split vertex and the vertices of the tetrahedra round it; a set of members is bits in the order of the
/// members.
struct DiamondStencil {
  using Members = std::uint32_t;
  static constexpr std::size_t kBegin = 0, kEnd = 1, kMiddle = 2, kRing = 3, kMost = kRing + 8;
  /// Edges between points on a page or one step round it are numbered by the sums of their ends, which lie in
  /// a grid of so many points along each axis, i running fastest.
  static constexpr std::int32_t kEdgeSide = 2 * (PaddedGrid<int>::kSide - 1) + 1;

  static constexpr std::int32_t edge_place(LatticePoint sum) {
    return sum.i + kEdgeSide * (sum.j + kEdgeSide * sum.k);
  }

  /// How many edges these numbers may name.
  static constexpr std::int32_t kEdgePlaces = kEdgeSide * kEdgeSide * kEdgeSide;
  /// The ends of the edge of a number, in ascending order; points are counted from the page's first one.
  static std::array<LatticePoint, 2> ends_of_edge(std::int32_t place);

  /// One of the two halves into which a tetrahedron is bisected.
  struct Half {
    std::uint8_t slot;                     ///< of the tetrahedron
    std::array<std::uint8_t, 4> vertices;  ///< members, in the child diamond's order
    Members members;                       ///< the same as a set
    /// `edge_place` of the edges, in the order of kTetrahedronEdges, less that of the split vertex with
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
  /// The offsets of the children. In phase 2 their unit is half the scale, as these children belong to the
  /// next finer LOD.
  std::array<LatticePoint, 8> children;
  std::array<Half, 16> halves;  ///< two for each child
  /// These tables are indexed by the set of members above a contour: the halves that it crosses, as bits; and
  /// how many more triangles it has in all halves than in the tetrahedra.
  std::vector<std::uint16_t> crossed;
  std::vector<std::int8_t> added;

  /// How many triangles a contour has in a tetrahedron with these vertices, where the members of `above` are
  /// above it.
  static int triangles(Members vertices, Members above) {
    const Members found = vertices & above;
    if (found == 0 || found == vertices) return 0;
    // Two triangles where two of the four vertices are above. Bits are taken away one by one, since the
    // compiler may make a call of counting them.
    const Members others = found & (found - 1);
    return others != 0 && (others & (others - 1)) == 0 ? 2 : 1;
  }

  /// The slots of all tetrahedra, as bits.
  [[nodiscard]] unsigned all_slots() const { return (1u << tetrahedron_count) - 1; }

  /// How many more triangles a contour has in the halves than in the tetrahedra, where only the tetrahedra of
  /// `slots`, as bits, count.
  [[nodiscard]] int added_in(unsigned slots, Members above) const;

  /// The stencil of the diamond at q, in units of its scale: only the two lowest bits of coordinates matter.
  static const DiamondStencil& at(LatticePoint q) {
    static const DiamondStencil* const kAll = all();
    return kAll[static_cast<std::size_t>(diamond_type(q, 0))];
  }

 private:
  /// The stencils of all diamond types, indexed by type.
  static const DiamondStencil* all();
};

}  // namespace adamas::isosurface
