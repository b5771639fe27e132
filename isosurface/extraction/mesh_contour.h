#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/page_mesh.h"
#include "isosurface/extraction/split_pages.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas::isosurface {

/// The contour of the mesh in which the diamonds of SplitPages are split, page by page.
template <class Sample>
class PageContour {
 public:
  /// All arguments must outlive this. The builder gets the triangles.
  PageContour(StoredDiamonds<Sample>& diamonds, const SplitPages<Sample>& pages, const SplitLimits& limits,
              ContourBuilder& builder);

  /// Adds the triangles in the tetrahedra of the mesh that come from splitting a page's diamonds. At least
  /// one of them must be split. Throws PageLost.
  void add(const SplitPage& page);

  /// How many more tetrahedra the mesh has than its root diamond.
  [[nodiscard]] std::uint64_t tetrahedra_added() const { return tetrahedra_; }
  /// The greatest error class of the split diamonds that have a child which is not split because of a lost
  /// page.
  [[nodiscard]] int greatest_class_at_lost() const { return greatest_class_at_lost_; }

 private:
  void note_lost_children(const Diamond& diamond);
  std::uint32_t edge_point(std::int32_t place);

  StoredDiamonds<Sample>& diamonds_;
  const SplitPages<Sample>& split_pages_;
  const SplitLimits& limits_;
  ContourBuilder& builder_;
  PageMesh<Sample> mesh_;
  std::vector<std::uint32_t> edge_points_;  ///< the numbers of the points on edges, by place
  std::vector<std::int32_t> used_;          ///< the places of the edges that have one
  std::uint64_t tetrahedra_ = 0;
  int greatest_class_at_lost_ = 0;
};

/// The contour of the mesh in which the diamonds of SplitPages are split, made by threads: each has a run of
/// the pages, from the coarsest LOD on, and their contours are put together in this order, so that the result
/// is the same on any number of threads.
template <class Sample>
class MeshContour {
 public:
  /// `of_threads`: the diamonds that each thread works with, of the same store and contour, but with pages of
  /// their own. All arguments must outlive this.
  MeshContour(std::span<StoredDiamonds<Sample>* const> of_threads, const SplitPages<Sample>& pages,
              const SplitLimits& limits, const SurfaceRequest& request);

  /// Makes the contour; must be called only once. Throws PageLost, and Error where the surface has more
  /// points than can be numbered.
  [[nodiscard]] Contour run(Progress& progress);

  /// See PageContour.
  [[nodiscard]] std::uint64_t tetrahedra_added() const;
  [[nodiscard]] int greatest_class_at_lost() const;

 private:
  /// Finds where the pages of each thread begin among all of them, and the end, so that each has about as
  /// many split diamonds.
  void find_runs();

  std::vector<const SplitPage*> pages_;
  std::vector<std::size_t> runs_;                               ///< by thread
  std::vector<std::unique_ptr<ContourBuilder>> builders_;       ///< by thread
  std::vector<std::unique_ptr<PageContour<Sample>>> contours_;  ///< by thread
};

extern template class MeshContour<std::uint8_t>;
extern template class MeshContour<std::uint16_t>;
extern template class MeshContour<std::int16_t>;
extern template class MeshContour<float>;

}  // namespace adamas::isosurface
