#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "isosurface/extraction/page_mask.h"
#include "isosurface/extraction/surface_normals.h"
#include "isosurface/view/surface_chunk.h"

namespace adamas::isosurface {

/// A chunk, with the data from which the page's next chunk is made. The page's diamonds lie in cells of 4^3:
/// the triangles of each cell stay together, and only cells with changes are made anew.
struct PageChunk {
  static constexpr std::int32_t kCellSide = 4;
  static constexpr std::size_t kCells = 64;
  /// Returns the cell of a diamond of the page.
  static unsigned cell(LatticePoint q) {
    return static_cast<unsigned>(q.i / kCellSide + 4 * (q.j / kCellSide) + 16 * (q.k / kCellSide));
  }
  /// The DiamondStencil::edge_place of an edge whose ends are counted from one step before the page's first
  /// point on.
  using EdgePlace = std::uint16_t;

  /// Triangles by the edges that their points lie on.
  struct Part {
    /// The triangles of cell n begin at begins[n], and end at begins[n + 1].
    std::vector<std::array<EdgePlace, 3>> triangles;
    std::array<std::uint32_t, kCells + 1> begins{};
    /// The number of edges of the triangles of the cells before each cell.
    std::array<std::uint32_t, kCells> edges_before{};
    /// The edges that have a point, in the order in which the triangles first use them; and the parameters of
    /// these points, as in EdgePoint, if the surface consists of points.
    std::vector<EdgePlace> edges;
    std::vector<double> parameters;
  };

  int lod = 0;
  LatticePoint block{};
  PageMask split;
  Part inside;  ///< triangles that are shown
  Part border;  ///< triangles in tetrahedra that extend beyond the data, which are clipped
  SurfaceChunk shown;
  /// The pages without which normals were computed, since they are not in memory; such normals are
  /// provisional.
  std::vector<MissingNormals> missing;
};

}  // namespace adamas::isosurface
