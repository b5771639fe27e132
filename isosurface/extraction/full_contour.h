#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "core/base/parallel.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/joined_surface.h"
#include "isosurface/extraction/split_limits.h"
#include "isosurface/extraction/stored_diamonds.h"

namespace adamas::isosurface {

/// Makes the joined contour (join_points) of the lattice of all samples, in which every diamond is split. It
/// works page by page, reads no errors and ranges, and never makes the triangles that joining removes.
template <class Sample>
class FullContour {
 public:
  /// Prepares the contour that is set in the diamonds, which must outlive this. Only the part in the region
  /// of `limits` is made. At most `most_threads` threads work on it.
  FullContour(StoredDiamonds<Sample>& diamonds, double isovalue, double least_parameter,
              const SplitLimits& limits, std::size_t most_threads = thread_limit());
  ~FullContour();

  /// Returns whether most pages that the contour crosses have errors there. Then a mesh that is refined only
  /// at errors would have hardly fewer triangles. Throws PageLost.
  [[nodiscard]] bool is_worthwhile();

  /// Returns the contour, up to the data's box; none where some sample next to it is not finite. The result
  /// is the same on any number of threads. Throws PageLost, and Error where the surface has more points than
  /// can be numbered.
  std::optional<Contour> run(Progress& progress);

  /// Returns the number of cells of samples that the contour crosses.
  [[nodiscard]] std::uint64_t crossed_cells() const { return crossed_cells_; }

 private:
  void find_blocks(int lod, LatticePoint block);
  [[nodiscard]] bool is_wanted(int lod, LatticePoint block) const;
  /// A cell, as its page and its first corner, which is counted from the page's first point.
  struct CellOfPage {
    LatticePoint block, cell;
  };
  struct Worker;

  /// Finds the slabs, which are all pages of one k. `slabs_` gets the index in blocks_ at which each begins,
  /// and the end.
  void find_slabs();
  void make_workers();
  /// Adds the triangles of a slab. Returns false where a sample is not finite.
  bool add_slab(std::size_t n, Worker& worker, SurfaceSlab& slab) const;
  /// Separates the coinciding patches, in one round.
  void separate(JoinedSurface& surface, Progress& progress);
  /// Returns the cells with a corner at the vertex of one of the patches, page by page, as their first
  /// corners.
  [[nodiscard]] std::vector<CellOfPage> cells_round(const std::vector<PointsOfVertex>& patches) const;
  static LatticeMap<bool> corners_of(const std::vector<CellOfPage>& cells);
  /// Calls visit(block, cells) for each page.
  template <class Visit>
  static void for_each_page(const std::vector<CellOfPage>& cells, const Visit& visit);

  StoredDiamonds<Sample>& diamonds_;
  double isovalue_, least_parameter_;
  const SplitLimits& limits_;
  std::size_t most_threads_;
  std::vector<LatticePoint> blocks_;  ///< pages of the finest LOD that the contour crosses, i running fastest
  std::vector<std::size_t> slabs_;
  std::vector<std::unique_ptr<Worker>> workers_;  ///< indexed by thread
  std::uint64_t crossed_cells_ = 0;
};

}  // namespace adamas::isosurface
