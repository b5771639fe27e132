#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/page_contour.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas::isosurface {

/// The contour of the mesh in which the diamonds of SplitPages are split, in threads: each has a run of the
/// pages, from the coarsest LOD on, and what they have is put together in this order, so that the contour is
/// the same on any number of them.
template <class Sample>
class MeshContour {
 public:
  /// `of_threads`: of the same store and contour, but with pages of their own. All must outlive this.
  MeshContour(std::span<StoredDiamonds<Sample>* const> of_threads, const SplitPages<Sample>& pages,
              const SplitLimits& limits, const SurfaceRequest& request);

  /// To be called once. Throws PageLost, and Error where the surface has more points than can be numbered.
  [[nodiscard]] Contour run(Progress& progress);

  /// See PageContour.
  [[nodiscard]] std::uint64_t tetrahedra_added() const;
  [[nodiscard]] int greatest_class_at_lost() const;

 private:
  /// By thread, where its pages begin among all of them, and the end: so that each has about as many split
  /// diamonds.
  void find_runs();

  struct Placed {
    int lod;
    const typename SplitPages<Sample>::PageOfLod* page;
  };

  std::vector<Placed> pages_;
  std::vector<std::size_t> runs_;
  std::vector<std::unique_ptr<ContourBuilder>> builders_;       ///< by thread
  std::vector<std::unique_ptr<PageContour<Sample>>> contours_;  ///< by thread
};

extern template class MeshContour<std::uint8_t>;
extern template class MeshContour<std::uint16_t>;
extern template class MeshContour<std::int16_t>;
extern template class MeshContour<float>;

}  // namespace adamas::isosurface
