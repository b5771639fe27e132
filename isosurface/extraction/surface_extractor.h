#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "isosurface/extraction/split_pages.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_request.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// Extracts isosurfaces of a store. They are contours of the mesh in which exactly those diamonds are split
/// that the surface crosses and whose error is too great. This mesh is conforming, since no child has a
/// greater error or range than its parents; so each diamond alone determines whether it is split, and no
/// table of the mesh is needed. For joined surfaces with error 0 nearly all diamonds are split: then the mesh
/// is the whole lattice (FullContour), except where most parts of the volume are flat and need few triangles.
template <class Sample>
class SurfaceExtractor {
 public:
  /// Makes an extractor of these pages, which must outlive it.
  explicit SurfaceExtractor(StoredPages<OrderedWord<Sample>>& pages);

  [[nodiscard]] StoredPages<OrderedWord<Sample>>& pages() const { return pages_; }
  [[nodiscard]] const Domain& domain() const { return diamonds_.domain(); }
  /// Returns the box from the first sample to the last, in the frame.
  [[nodiscard]] Box3 data_box() const { return diamonds_.data_box(); }
  [[nodiscard]] Vec3 spacing() const { return diamonds_.spacing(); }
  /// Returns the least and the greatest finite sample of the store, the first greater where there is none.
  /// Throws PageLost.
  std::array<double, 2> range();

  /// Extracts a surface. Throws Error where the store is too damaged for any surface, or damaged at all and
  /// the request strict.
  ExtractedSurface extract(const SurfaceRequest& request, Progress& progress = SilentProgress::instance());

 private:
  ExtractedSurface extract_once(Progress& progress);
  /// Returns the cut of TriangleBudget.
  SurfaceCut cut_of(std::uint64_t triangles, int least_class, Progress& progress);
  /// Makes a surface of at most the wanted number of triangles by decimation of a finer one.
  ExtractedSurface decimated(int least_class, Progress& progress);
  ExtractedSurface contour_of(const SurfaceCut& cut, Progress& progress);
  ExtractedSurface contour_of_mesh(Progress& progress);
  /// Makes a Helper for each thread but the first.
  void make_helpers(std::size_t threads);
  void find_split(const SurfaceCut& cut, Progress& progress);
  /// Returns the surface of the mesh in which everything is split; none where FullContour cannot or should
  /// not make it.
  std::optional<ExtractedSurface> full_contour(Progress& progress);
  /// Removes the parts outside the region and beyond the sides.
  void clip(Contour& contour) const;
  /// Returns the surface of the mesh in which nothing is split.
  ExtractedSurface contour_of_root();
  [[nodiscard]] ContourOptions contour_options() const;

  /// The diamonds and pages of a thread other than the first one.
  struct Helper {
    StoredDiamonds<Sample> diamonds;
    CrossedPageReader<Sample> reader;

    Helper(StoredPages<OrderedWord<Sample>>& pages, const SurfaceRequest& request, const SplitLimits& limits)
        : diamonds(pages), reader(diamonds, request, &limits) {}
  };

  StoredPages<OrderedWord<Sample>>& pages_;
  StoredDiamonds<Sample> diamonds_;
  SurfaceRequest request_;
  SplitLimits limits_;
  SplitPages<Sample> split_pages_;
  std::vector<std::unique_ptr<Helper>> helpers_;
  std::size_t threads_ = 1;  ///< greatest number of threads for a surface
};

}  // namespace adamas::isosurface
