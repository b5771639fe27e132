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
  /// Returns the place of a point in any grid.
  static constexpr std::size_t place(LatticePoint q) {
    return static_cast<std::size_t>(offset({q.i + 1, q.j + 1, q.k + 1}));
  }
  /// Returns the difference of places for a step.
  static constexpr std::ptrdiff_t offset(LatticePoint d) { return d.i + kSide * (d.j + kSide * d.k); }

 private:
  std::array<T, kPoints> numbers_;
};

/// A type of split diamonds, as tables for contours in their halves. A diamond's members are the split vertex
/// and the vertices of the tetrahedra round it; a set of members is bits in the order of the members.
struct DiamondStencil {
  using Members = std::uint32_t;
  static constexpr std::size_t kBegin = 0, kEnd = 1, kMiddle = 2, kRing = 3, kMost = kRing + 8;
  /// Edges between points on a page or one step round it are numbered by the sums of their ends, which lie in
  /// a grid of so many points along each axis, i running fastest.
  static constexpr std::int32_t kEdgeSide = 2 * (PaddedGrid<int>::kSide - 1) + 1;

  static constexpr std::int32_t edge_place(LatticePoint sum) {
    return sum.i + kEdgeSide * (sum.j + kEdgeSide * sum.k);
  }

  /// The number of these edge numbers.
  static constexpr std::int32_t kEdgePlaces = kEdgeSide * kEdgeSide * kEdgeSide;
  /// Returns the ends of the edge with a number, in ascending order; points are counted from the page's first
  /// one.
  static std::array<LatticePoint, 2> ends_of_edge(std::int32_t place);

  /// One of the two halves into which a tetrahedron is bisected.
  struct Half {
    std::uint8_t slot;                     ///< the slot of the tetrahedron
    std::array<std::uint8_t, 4> vertices;  ///< the vertices as members, in the child diamond's order
    Members members;                       ///< the vertices as a set
    /// The `edge_place` of each edge, in the order of kTetrahedronEdges, less the edge_place of the split
    /// vertex with itself.
    std::array<std::int32_t, 6> edges;
  };

  int phase;
  std::size_t count;                        ///< number of members
  std::array<LatticePoint, kMost> offsets;  ///< offsets of the members in units of the diamond's scale
  std::array<std::int32_t, kMost> places;   ///< offsets of the members in a PaddedGrid
  std::size_t tetrahedron_count;
  std::array<Members, 8> tetrahedra;  ///< vertices of the tetrahedra, indexed by slot
  std::size_t child_count;
  /// The offsets of the children. In phase 2 their unit is half the scale, as these children belong to the
  /// next finer LOD.
  std::array<LatticePoint, 8> children;
  std::array<Half, 16> halves;  ///< two for each child
  /// These tables are indexed by the set of members above a contour: the halves that it crosses, as bits; and
  /// the number of triangles that it has in all halves more than in the tetrahedra.
  std::vector<std::uint16_t> crossed;
  std::vector<std::int8_t> added;

  /// Returns the number of triangles of a contour in a tetrahedron with these vertices, if the members of
  /// `above` are above it.
  static int triangles(Members vertices, Members above) {
    const Members found = vertices & above;
    if (found == 0 || found == vertices) return 0;
    // There are two triangles if two of the four vertices are above. Bits are removed one by one, since the
    // compiler may make a call of counting them.
    const Members others = found & (found - 1);
    return others != 0 && (others & (others - 1)) == 0 ? 2 : 1;
  }

  /// Returns the slots of all tetrahedra, as bits.
  [[nodiscard]] unsigned all_slots() const { return (1u << tetrahedron_count) - 1; }

  /// Returns the number of triangles of a contour in the halves more than in the tetrahedra, for the
  /// tetrahedra of `slots`, as bits.
  [[nodiscard]] int added_in(unsigned slots, Members above) const;

  /// Returns the stencil of the diamond at q, in units of its scale: only the two lowest bits of coordinates
  /// matter.
  static const DiamondStencil& at(LatticePoint q) {
    static const DiamondStencil* const kAll = all();
    return kAll[static_cast<std::size_t>(diamond_type(q, 0))];
  }

 private:
  /// Returns the stencils of all diamond types, indexed by type.
  static const DiamondStencil* all();
};

}  // namespace adamas::isosurface
