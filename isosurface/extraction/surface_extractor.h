#pragma once

#include <array>
#include <cstdint>

#include "core/base/progress.h"
#include "isosurface/extraction/split_pages.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_request.h"
#include "isosurface/volume/samples.h"

namespace adamas {

/// Isosurfaces of a store. The mesh they come from is that in which just those diamonds are split that the
/// surface crosses with an error that is too great: since no child has a greater error or range than a
/// parent, it is conforming, and a diamond at a time tells of it without a table of the mesh.
template <class Sample>
class SurfaceExtractor {
 public:
  /// The pages must outlive this.
  explicit SurfaceExtractor(StoredPages<OrderedWord<Sample>>& pages);

  [[nodiscard]] const Domain& domain() const { return diamonds_.domain(); }
  /// Least and greatest sample of the store.
  std::array<double, 2> range() { return diamonds_.range(); }

  /// Throws Error where the store is too damaged for any surface, or damaged at all and the request strict.
  ExtractedSurface extract(const SurfaceRequest& request, Progress& progress = SilentProgress::instance());

 private:
  ExtractedSurface extract_once(Progress& progress);
  ExtractedSurface contour_of(const SurfaceCut& cut, Progress& progress);
  ExtractedSurface contour_of_mesh(Progress& progress);
  /// Of the mesh in which nothing is split.
  ExtractedSurface contour_of_root();

  StoredDiamonds<Sample> diamonds_;
  int subtree_bisections_;
  LatticePoint root_;
  SurfaceRequest request_;
  SplitLimits limits_;
  SplitPages<Sample> pages_;
};

extern template class SurfaceExtractor<std::uint8_t>;
extern template class SurfaceExtractor<std::uint16_t>;
extern template class SurfaceExtractor<std::int16_t>;
extern template class SurfaceExtractor<float>;

}  // namespace adamas
