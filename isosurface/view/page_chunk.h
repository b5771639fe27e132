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
/// the triangles of each cell stay together, and only cells in which something has changed are made anew.
struct PageChunk {
  static constexpr std::int32_t kCellSide = 4;
  static constexpr std::size_t kCells = 64;
  /// The cell of a diamond of the page.
  static unsigned cell(LatticePoint q) {
    return static_cast<unsigned>(q.i / kCellSide + 4 * (q.j / kCellSide) + 16 * (q.k / kCellSide));
  }
  /// The DiamondStencil::edge_place of an edge whose ends are counted from one step before the page's first
  /// point on.
  using EdgePlace = std::uint16_t;

  /// Triangles by the edges that their points lie on.
  struct Part {
    /// The triangles of a cell begin at its number in `begins`, and end where those of the next cell begin.
    std::vector<std::array<EdgePlace, 3>> triangles;
    std::array<std::uint32_t, kCells + 1> begins{};
    /// How many edges the triangles of the cells before each cell have.
    std::array<std::uint32_t, kCells> edges_before{};
    /// The edges that have a point, in the order in which they are first met in the triangles; and the
    /// parameters of these points, as in EdgePoint, where the surface consists of points.
    std::vector<EdgePlace> edges;
    std::vector<double> parameters;
  };

  int lod = 0;
  LatticePoint block{};
  PageMask split;
  Part inside;  ///< the triangles that are shown
  Part border;  ///< those in tetrahedra that reach beyond the data, which are to be cut
  SurfaceChunk shown;
  /// The pages that normals were computed without, since they are not in memory; such normals are
  /// provisional.
  std::vector<MissingNormals> missing;
};

}  // namespace adamas::isosurface
