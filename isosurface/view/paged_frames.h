#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "core/lattice/lattice_map.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/split_pages.h"
#include "isosurface/extraction/surface_request.h"
#include "isosurface/view/frame_refinement.h"
#include "isosurface/view/viewed_diamonds.h"

namespace adamas {

/// Frames by masks of pages: each frame is the cut of the diamonds by their classes in the view, and a limit
/// of triangles splits them in the order of SurfaceCut. So a frame does not depend on those before it, but
/// for the pages that are in memory. The mesh is that of QueuedFrames, where the error wanted is the least of
/// a class and there is room.
template <class Sample>
class PagedFrames {
 public:
  /// The pages must outlive this.
  explicit PagedFrames(StoredPages<OrderedWord<Sample>>& pages);

  /// Finds the surface of a frame. A stopped one leaves what there was, or the mesh in which nothing is split
  /// where that is of another contour or has too many triangles; its greatest error is not known then. Throws
  /// PageLost.
  FrameFigures refine(const FrameRequest& request);

  /// The surface of the last frame, clipped to the data's box.
  [[nodiscard]] const Contour& contour() const { return contour_; }
  [[nodiscard]] const ViewedDiamonds<Sample>& diamonds() const { return diamonds_; }

 private:
  /// Leaves the surface of the mesh in which nothing is split.
  void merge_all();
  SurfaceCut cut_of(const FrameRequest& request, Progress& progress);
  void count_changes(FrameFigures& figures);
  Contour contour_of_mesh(Progress& progress);

  ViewedDiamonds<Sample> diamonds_;
  SplitLimits limits_;
  SplitPages<Sample> split_pages_;
  SurfaceRequest surface_;
  std::optional<double> isovalue_;  ///< none before the first frame
  Contour contour_;
  FrameFigures figures_;                     ///< of the last frame that was not stopped
  std::vector<LatticeMap<PageMask>> masks_;  ///< by LOD: what was split in that frame, by block
};

extern template class PagedFrames<std::uint8_t>;
extern template class PagedFrames<std::uint16_t>;
extern template class PagedFrames<std::int16_t>;
extern template class PagedFrames<float>;

}  // namespace adamas
