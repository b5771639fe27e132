#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "isosurface/extraction/diamond_vertices.h"
#include "isosurface/extraction/lost_regions.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_request.h"

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
  using Points = std::vector<LatticePoint>;

  /// Which diamonds are split: those of greater rank, those of that rank and an earlier generation, and some
  /// of that generation.
  struct Cut {
    int rank = 0;
    int generation = 0;
    Points last;  ///< in ascending order
  };
  ExtractedSurface extract_once(Progress& progress);
  Cut cut_by_error() const;
  Cut cut_by_triangles(std::uint64_t budget, Progress& progress);
  using ChildTetrahedra = std::array<DiamondType::ChildTetrahedron, 2>;
  /// Goes through the mesh of a cut: split(diamond) for the diamonds that are split, parents first, each
  /// followed by leaf(halves, child, rank) for those of its children that are not, with which of its
  /// tetrahedra's halves they have; leaf(null, root, rank) where nothing is split.
  template <class Split, class Leaf>
  void walk(const Cut& cut, Progress& progress, Split&& split, Leaf&& leaf);
  ExtractedSurface contour_of(const Cut& cut, Progress& progress);
  ExtractedSurface contour_of_mesh(const Cut& cut, Progress& progress);
  ExtractedSurface contour_of_subtrees(const Cut& cut, Progress& progress);

  /// The least rank whose error is greater than the one wanted.
  [[nodiscard]] int least_rank() const { return diamonds_.rank_within(request_.error) + 1; }
  /// The rank of a diamond that may be split, 0 of others.
  int rank(LatticePoint p);
  /// Whether the cut splits the diamond, whose rank is `rank`.
  [[nodiscard]] bool is_split(LatticePoint p, int rank, const Cut& cut) const;
  /// Whether pages that cannot be had keep the diamond from being split.
  [[nodiscard]] bool is_lost(LatticePoint p) const;
  [[nodiscard]] bool reaches_region(LatticePoint p, int level, int phase) const;
  /// Whether `parent` is that of its parents through which `child` is come to.
  [[nodiscard]] bool leads_to(LatticePoint parent, LatticePoint child) const;
  [[nodiscard]] int generation(LatticePoint p) const;
  /// Brings diamonds of one generation into the order of their pages in the file: each page is looked at
  /// once.
  void sort_by_page(Points& points) const;
  DiamondVertices vertices(const Diamond& diamond, bool with_middle);

  StoredDiamonds<Sample> diamonds_;
  int subtree_bisections_;
  LatticePoint root_;
  LostRegions lost_;
  SurfaceRequest request_;
  std::optional<std::array<Vec3, 2>> region_;  ///< in samples
};

extern template class SurfaceExtractor<std::uint8_t>;
extern template class SurfaceExtractor<std::uint16_t>;
extern template class SurfaceExtractor<std::int16_t>;
extern template class SurfaceExtractor<float>;

}  // namespace adamas
