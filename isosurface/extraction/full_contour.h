#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/page_cells.h"
#include "isosurface/extraction/split_limits.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/joined_surface.h"

namespace adamas {

/// The joined contour (join_points) of the lattice of all samples, in which every diamond is split: page by
/// page, without errors and ranges, and without ever having the triangles that joining takes away.
template <class Sample>
class FullContour {
 public:
  /// Of a contour that is set in the diamonds, which must outlive this. `limits`: only what the region
  /// reaches is wanted.
  FullContour(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter,
              const SplitLimits& limits);

  /// Whether most pages that the contour crosses have errors there, so that a mesh that is refined where
  /// there are some would have hardly fewer triangles. Throws PageLost.
  [[nodiscard]] bool is_worthwhile();

  /// The contour, up to the data's box; nothing where some sample next to it is not finite. On as many threads
  /// as are allowed, and the same on any number of them. Throws PageLost, and Error where the surface has more
  /// points than can be numbered.
  std::optional<Contour> run(Progress& progress);

  /// How many cells of samples it crosses.
  [[nodiscard]] std::uint64_t crossed_cells() const { return crossed_cells_; }

 private:
  void find_blocks(int lod, LatticePoint block);
  [[nodiscard]] bool is_wanted(int lod, LatticePoint block) const;
  /// A cell, by its page and its first corner, from the page's first point on.
  struct CellOfPage {
    LatticePoint block, cell;
  };
  using Apart = typename PageCells<Sample>::Apart;

  /// The cells that have a corner at the vertex of one of these, by page; and their corners.
  [[nodiscard]] std::vector<CellOfPage> cells_round(const std::vector<PointsOfVertex>& patches) const;
  static LatticeMap<bool> corners_of(const std::vector<CellOfPage>& cells);
  /// Returns false where a sample is not finite.
  bool add_slab(const std::vector<LatticePoint>& blocks, PageCells<Sample>& cells, SurfaceSlab& slab, Apart& apart);
  /// Takes patches apart until nothing coincides.
  void take_apart(JoinedSurface& surface, PageCells<Sample>& cells, Apart& apart, Progress& progress);
  /// Adds to a slab the triangles in these cells that have new points.
  void add_again(const std::vector<CellOfPage>& cells, PageCells<Sample>& of_pages, const Apart& apart, SurfaceSlab& slab);

  StoredDiamonds<Sample>& diamonds_;
  double isovalue_, least_parameter_;
  const SplitLimits& limits_;
  std::vector<LatticePoint> blocks_;  ///< pages of the finest LOD that the contour crosses, i running fastest
  std::uint64_t crossed_cells_ = 0;
};

extern template class FullContour<std::uint8_t>;
extern template class FullContour<std::uint16_t>;
extern template class FullContour<std::int16_t>;
extern template class FullContour<float>;

}  // namespace adamas
