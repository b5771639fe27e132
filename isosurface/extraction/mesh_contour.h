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

/// Makes the contour of the mesh in which the diamonds of SplitPages are split, page by page.
template <class Sample>
class PageContour {
 public:
  /// Makes the object. All arguments must outlive it. The builder gets the triangles.
  PageContour(StoredDiamonds<Sample>& diamonds, const SplitPages<Sample>& pages, const SplitLimits& limits,
              ContourBuilder& builder);

  /// Adds the triangles in the tetrahedra of the mesh that come from splitting a page's diamonds. At least
  /// one of them must be split. Throws PageLost.
  void add(const SplitPage& page);

  /// Returns the number of tetrahedra that the mesh has more than its root diamond.
  [[nodiscard]] std::uint64_t tetrahedra_added() const { return tetrahedra_; }
  /// Returns the greatest error class of the split diamonds with a child that is not split because of a lost
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
  /// Numbers of the points on edges, indexed by the place of the edge.
  std::vector<std::uint32_t> edge_points_;
  std::vector<std::int32_t> used_;  ///< places of the edges that have a point
  std::uint64_t tetrahedra_ = 0;
  int greatest_class_at_lost_ = 0;
};

/// Makes the contour of the mesh in which the diamonds of SplitPages are split, in threads: each has a range
/// of the pages, from the coarsest LOD on, and their contours are joined in this order, so that the result is
/// the same on any number of threads.
template <class Sample>
class MeshContour {
 public:
  /// Makes the object. `thread_diamonds`: the diamonds of each thread, of the same store and contour, but
  /// with separate pages. All arguments must outlive this.
  MeshContour(std::span<StoredDiamonds<Sample>* const> thread_diamonds, const SplitPages<Sample>& pages,
              const SplitLimits& limits, const SurfaceRequest& request);

  /// Makes the contour; must be called only once. Throws PageLost, and Error where the surface has more
  /// points than can be numbered.
  [[nodiscard]] Contour run(Progress& progress);

  /// Returns the sum or the greatest of the values of all PageContours.
  [[nodiscard]] std::uint64_t tetrahedra_added() const;
  [[nodiscard]] int greatest_class_at_lost() const;

 private:
  /// Finds the first page of each thread among all of them, and the end, so that each thread has about as
  /// many split diamonds.
  void find_runs();

  std::vector<const SplitPage*> pages_;
  std::vector<std::size_t> runs_;                               ///< by thread
  std::vector<std::unique_ptr<ContourBuilder>> builders_;       ///< by thread
  std::vector<std::unique_ptr<PageContour<Sample>>> contours_;  ///< by thread
};

}  // namespace adamas::isosurface
