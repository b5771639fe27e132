#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

// This header describes the lattice where every diamond is split: each cell of samples consists of the six
// tetrahedra round the diagonal from its corner with even coordinates to the one with odd ones. So there are
// eight kinds of cells, by the parities of their first corner, and eight kinds of vertices, by their own;
// parities are bits, that of i lowest.

/// Returns the step from a cell's first corner to another corner, whose number has bit 0 for a step along i,
/// bit 1 for one along j, and bit 2 for one along k.
constexpr LatticePoint corner_offset(unsigned corner) {
  return {static_cast<std::int32_t>(corner & 1), static_cast<std::int32_t>(corner >> 1 & 1),
          static_cast<std::int32_t>(corner >> 2 & 1)};
}

struct CellContour {
  struct Edge {
    std::uint8_t a, b;  ///< corners
    std::uint8_t sum;   ///< sum of their coordinates: i + 3 j + 9 k
  };

  std::uint8_t edge_count = 0, triangle_count = 0;
  std::array<Edge, 19> edges{};  ///< the edges that the contour crosses
  /// Triangles as indices of edges; normals point to corners below.
  std::array<std::array<std::uint8_t, 3>, 12> triangles{};

  /// Returns the contour of a cell, given its parity and the set of its corners above, as bits.
  static const CellContour& find(unsigned parity, unsigned above);
};

/// The neighbours of a vertex of the lattice. Each has a number, 13 + i + 3 j + 9 k for steps from -1 to 1
/// along each axis, and sets of them are bits.
struct VertexLink {
  using Set = std::uint32_t;
  static constexpr int kCount = 27;

  Set neighbours = 0;                ///< the neighbours that edges connect with the vertex
  std::array<Set, kCount> adjacent;  ///< for each neighbour, the neighbours with which it shares an edge

  static constexpr LatticePoint step(int neighbour) {
    return {neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1};
  }

  /// Returns the connected component of `among` that contains its first member.
  [[nodiscard]] Set component(Set among) const;
  /// Returns whether the patch of a contour with its points on the edges to a connected component is a disc.
  [[nodiscard]] bool is_disc(Set component) const;

  /// Returns the neighbours of a vertex, given its parity.
  static const VertexLink& find(unsigned parity);
};

}  // namespace adamas::isosurface
