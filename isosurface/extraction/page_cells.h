#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "isosurface/contour/cell_contour.h"
#include "isosurface/extraction/joined_surface.h"
#include "isosurface/extraction/page_box.h"

namespace adamas::isosurface {

/// The joined contour in the cells of a page of the finest LOD.
template <class Sample>
class PageCells {
 public:
  /// Which points next to a vertex, in samples, are not joined: those on the edges to these neighbours.
  using Apart = LatticeMap<VertexLink::Set>;

  /// The diamonds must outlive this.
  PageCells(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter);

  /// Adds the triangles of a page's cells to a slab. Returns false where a sample there is not finite. Throws
  /// PageLost.
  bool add(LatticePoint block, SurfaceSlab& slab);
  /// Adds those triangles of some of the cells that have edge points with numbers from `first_new` on. All
  /// others next to the cells' corners are shared by the slab. `cells`: first corners, from that of the page
  /// on.
  void add_again(LatticePoint block, std::span<const LatticePoint> cells, const Apart& apart,
                 std::uint32_t first_new, SurfaceSlab& slab);

 private:
  using Set = VertexLink::Set;
  static constexpr std::uint16_t kNone = 0xffff;
  /// Edges have places by the sums of their ends, which lie in a grid of so many points along each axis.
  static constexpr std::int32_t kEdgeSide = 2 * (PageBox<Sample>::kLast - PageBox<Sample>::kFirst) + 1;
  static constexpr std::int32_t edge_place(LatticePoint sum) {
    const LatticePoint at =
        sum - 2 * LatticePoint{PageBox<Sample>::kFirst, PageBox<Sample>::kFirst, PageBox<Sample>::kFirst};
    return at.i + kEdgeSide * (at.j + kEdgeSide * at.k);
  }
  /// By CellContour::Edge::sum: the place less that of twice the cell's first corner.
  static constexpr auto kPlacesOfSums = [] {
    std::array<std::int32_t, 27> places{};
    for (std::int32_t n = 0; n < 27; ++n)
      places[static_cast<std::size_t>(n)] = n % 3 + kEdgeSide * (n / 3 % 3 + kEdgeSide * (n / 9));
    return places;
  }();

  /// Where the contour crosses an edge, and the number of what that point is joined to.
  struct CrossedEdge {
    Vec3 position;
    std::uint32_t number;
  };

  bool load(LatticePoint block);
  /// The contour in a cell; sets the places in `crossed_` of its edges.
  const CellContour& contour_of(LatticePoint cell, SurfaceSlab& slab, std::array<std::uint16_t, 19>& edges);
  void add_cell(LatticePoint cell, SurfaceSlab& slab);
  void add_geometry(const std::array<std::uint16_t, 3>& corners, SurfaceSlab& slab) const;
  /// Gives numbers to all points that are nearer to a vertex than to another.
  void add_vertex(LatticePoint v, SurfaceSlab& slab);
  /// The vertex's neighbours with the points on the edges to them.
  Set points_near(LatticePoint v, const VertexLink& link);
  /// The number of a patch, or of one point, which is added to the slab where that does not share it yet.
  std::uint32_t number_of(LatticePoint v, Set points, SurfaceSlab& slab);
  [[nodiscard]] Set neighbours_above(LatticePoint v) const;
  [[nodiscard]] bool is_above(LatticePoint v) const { return (box_.above(v.j, v.k) >> (v.i + 1) & 1) != 0; }
  /// How far a sample is from the isovalue.
  [[nodiscard]] double height(LatticePoint v) const { return std::abs(box_.value(v) - isovalue_); }
  /// Neighbours of the vertex that the data do not have, and those on a side of the data's box that has the
  /// vertex too.
  [[nodiscard]] Set outside(LatticePoint v) const;
  [[nodiscard]] Set on_border(LatticePoint v) const;
  [[nodiscard]] LatticePoint in_samples(LatticePoint v) const { return first_ + v; }
  [[nodiscard]] LatticePoint in_lattice(LatticePoint v) const { return lattice_step_ * in_samples(v); }

  StoredDiamonds<Sample>& diamonds_;
  double isovalue_, least_parameter_;
  std::int32_t lattice_step_;
  PageBox<Sample> box_;
  LatticePoint first_{};          ///< the page's first point, in samples
  const Apart* apart_ = nullptr;  ///< null where all that can be is joined
  std::vector<CrossedEdge> crossed_;
  std::vector<std::uint16_t> places_;               ///< by edge_place: the place in crossed_, or kNone
  std::vector<std::int32_t> used_;                  ///< the edge_place of each in crossed_
  std::array<EdgePoint, VertexLink::kCount> near_;  ///< by neighbour: the points near the present vertex
  std::array<Vec3, VertexLink::kCount> positions_;
};

extern template class PageCells<std::uint8_t>;
extern template class PageCells<std::uint16_t>;
extern template class PageCells<std::int16_t>;
extern template class PageCells<float>;

}  // namespace adamas::isosurface
