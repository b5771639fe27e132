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

/// Makes the joined contour in the cells of a page of the finest LOD.
template <class Sample>
class PageCells {
 public:
  /// The points that are not joined, by the vertex next to them, in samples: those on the edges to the
  /// neighbours of the set.
  using Apart = LatticeMap<VertexLink::Set>;

  /// Makes the object. The diamonds must outlive it.
  PageCells(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter);

  /// Adds the triangles of a page's cells to a slab. Returns false where a sample there is not finite. Throws
  /// PageLost.
  bool add(LatticePoint block, SurfaceSlab& slab);
  /// Adds the triangles of some cells that have edge points with numbers from `first_new` on; the slab shares
  /// all other points next to the cells' corners. `cells`: the cells' first corners, counted from the page's
  /// first point.
  void add_again(LatticePoint block, std::span<const LatticePoint> cells, const Apart& apart,
                 std::uint32_t first_new, SurfaceSlab& slab);

 private:
  using Set = VertexLink::Set;
  static constexpr std::uint16_t kNone = 0xffff;
  /// The place of an edge is the place of the sum of its ends in a grid of so many points along each axis.
  static constexpr std::int32_t kEdgeSide = 2 * (PageBox<Sample>::kLast - PageBox<Sample>::kFirst) + 1;
  static constexpr std::int32_t edge_place(LatticePoint sum) {
    const LatticePoint at =
        sum - 2 * LatticePoint{PageBox<Sample>::kFirst, PageBox<Sample>::kFirst, PageBox<Sample>::kFirst};
    return at.i + kEdgeSide * (at.j + kEdgeSide * at.k);
  }
  /// The place of an edge less that of twice the cell's first corner, indexed by CellContour::Edge::sum.
  static constexpr auto kPlacesOfSums = [] {
    std::array<std::int32_t, 27> places{};
    for (std::int32_t n = 0; n < 27; ++n)
      places[static_cast<std::size_t>(n)] = n % 3 + kEdgeSide * (n / 3 % 3 + kEdgeSide * (n / 9));
    return places;
  }();

  /// The point where the contour crosses an edge, and the number of the point that it is joined to.
  struct CrossedEdge {
    Vec3 position;
    std::uint32_t number;
  };

  bool load(LatticePoint block);
  /// Returns the contour in a cell, and sets the places of its edges in `crossed_`.
  const CellContour& contour_of(LatticePoint cell, SurfaceSlab& slab, std::array<std::uint16_t, 19>& edges);
  void add_cell(LatticePoint cell, SurfaceSlab& slab);
  void add_geometry(const std::array<std::uint16_t, 3>& corners, SurfaceSlab& slab) const;
  /// Gives numbers to all points that are nearer to this vertex than to the other ends of their edges.
  void add_vertex(LatticePoint v, SurfaceSlab& slab);
  /// Returns the neighbours of the vertex such that the edge to the neighbour has a point near the vertex.
  Set points_near(LatticePoint v, const VertexLink& link);
  /// Returns the number of a patch, or of a single point. It is added to the slab unless the slab shares it.
  std::uint32_t number_of(LatticePoint v, Set points, SurfaceSlab& slab);
  [[nodiscard]] Set neighbours_above(LatticePoint v) const;
  [[nodiscard]] bool is_above(LatticePoint v) const { return (box_.above(v.j, v.k) >> (v.i + 1) & 1) != 0; }
  /// Returns the distance between a sample and the isovalue.
  [[nodiscard]] double height(LatticePoint v) const { return std::abs(box_.value(v) - isovalue_); }
  /// Returns the neighbours of the vertex outside the data. on_border() returns those on a side of the data's
  /// box on which the vertex lies too.
  [[nodiscard]] Set outside(LatticePoint v) const;
  [[nodiscard]] Set on_border(LatticePoint v) const;
  [[nodiscard]] LatticePoint in_samples(LatticePoint v) const { return first_ + v; }
  [[nodiscard]] LatticePoint in_lattice(LatticePoint v) const { return lattice_step_ * in_samples(v); }

  StoredDiamonds<Sample>& diamonds_;
  double isovalue_, least_parameter_;
  std::int32_t lattice_step_;
  PageBox<Sample> box_;
  LatticePoint first_{};          ///< the page's first point, in samples
  const Apart* apart_ = nullptr;  ///< null: all points are joined where possible
  std::vector<CrossedEdge> crossed_;
  std::vector<std::uint16_t> places_;  ///< places in crossed_, or kNone, indexed by edge_place
  std::vector<std::int32_t> used_;     ///< the edge_place of each element of crossed_
  /// The points near the present vertex, indexed by neighbour.
  std::array<EdgePoint, VertexLink::kCount> near_;
  std::array<Vec3, VertexLink::kCount> positions_;
};

extern template class PageCells<std::uint8_t>;
extern template class PageCells<std::uint16_t>;
extern template class PageCells<std::int16_t>;
extern template class PageCells<float>;

}  // namespace adamas::isosurface
