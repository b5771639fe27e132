#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// Contours where the lattice is refined everywhere: each cell of samples consists of the six tetrahedra
/// round the diagonal from its corner with even coordinates to the one with odd ones. So a cell is one of
/// eight by the parities of its first corner, and a vertex one of eight by its own; parities are bits, that
/// of i lowest. A cell's corner has bit 0 where it is behind the first one along i, 1 along j, 2 along k.
constexpr LatticePoint corner_offset(unsigned corner) {
  return {static_cast<std::int32_t>(corner & 1), static_cast<std::int32_t>(corner >> 1 & 1),
          static_cast<std::int32_t>(corner >> 2 & 1)};
}

struct CellContour {
  struct Edge {
    std::uint8_t a, b;  ///< corners
    std::uint8_t sum;   ///< of their coordinates: i + 3 j + 9 k
  };

  std::uint8_t edge_count = 0, triangle_count = 0;
  std::array<Edge, 19> edges{};                             ///< that the contour crosses
  std::array<std::array<std::uint8_t, 3>, 12> triangles{};  ///< by edges; normals point to corners below

  /// By the cell's parity and the corners above, as bits.
  static const CellContour& of(unsigned parity, unsigned above);
};

/// The neighbours of a vertex of that lattice, as numbers and as bits of a set: 13 + i + 3 j + 9 k for those
/// at steps from -1 to 1.
struct VertexLink {
  using Set = std::uint32_t;
  static constexpr int kCount = 27;

  Set neighbours = 0;                ///< at the other ends of its edges
  std::array<Set, kCount> adjacent;  ///< of these: with which each shares an edge

  static constexpr LatticePoint step(int neighbour) {
    return {neighbour % 3 - 1, neighbour / 3 % 3 - 1, neighbour / 9 - 1};
  }

  /// The part of `among` that hangs together with its first one.
  [[nodiscard]] Set component(Set among) const;
  /// Whether the patch of a contour is a disc that has its points on the edges to these, which hang together.
  [[nodiscard]] bool is_disc(Set component) const;

  /// By the vertex's parity.
  static const VertexLink& of(unsigned parity);
};

}  // namespace adamas::isosurface
