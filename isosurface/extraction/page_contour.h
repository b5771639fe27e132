#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "isosurface/contour/contour.h"
#include "isosurface/extraction/page_diamonds.h"
#include "isosurface/extraction/split_pages.h"

namespace adamas::isosurface {

/// The contour of the mesh in which the diamonds of SplitPages are split, page by page. No table of the mesh
/// is needed: whether the halves that a split makes are part of it follows from the masks of split diamonds.
template <class Sample>
class PageContour {
 public:
  /// All of these must outlive this. The builder gets the triangles.
  PageContour(StoredDiamonds<Sample>& diamonds, const SplitPages<Sample>& pages, const SplitLimits& limits,
              ContourBuilder& builder);

  /// Adds the triangles in the tetrahedra of the mesh that come from splitting a page's diamonds. At least
  /// one of them must be split. Throws PageLost.
  void add(int lod, const typename SplitPages<Sample>::PageOfLod& page);

  /// How many tetrahedra the mesh has more than the diamonds of its root.
  [[nodiscard]] std::uint64_t tetrahedra_added() const { return tetrahedra_; }
  /// The greatest error class of the split diamonds of which a child is kept from being split by pages that
  /// cannot be had.
  [[nodiscard]] int greatest_class_at_lost() const { return greatest_class_at_lost_; }

 private:
  using PageOfLod = typename SplitPages<Sample>::PageOfLod;
  using Members = DiamondStencil::Members;

  /// What is split of a page and of those round it, null where nothing is, by steps from -1 to 1 along each
  /// axis.
  using Neighbours = std::array<const PageMask*, 27>;
  [[nodiscard]] Neighbours neighbours(int lod, LatticePoint block) const;

  void add_diamond(const DiamondStencil& stencil, LatticePoint q);
  void note_lost_children(const Diamond& diamond);
  void add_half(const DiamondStencil& stencil, LatticePoint q, const DiamondStencil::Half& half,
                Members above);
  std::uint32_t edge_point(LatticePoint a, LatticePoint b);
  void forget_edge_points();

  StoredDiamonds<Sample>& diamonds_;
  const SplitPages<Sample>& split_pages_;
  const SplitLimits& limits_;
  ContourBuilder& builder_;
  PageDiamonds<Sample> page_;
  Neighbours same_{}, finer_{};  ///< of the page's LOD and the next finer one
  /// The numbers of the points on edges, by DiamondStencil::edge_place; and the places that have one.
  std::vector<std::uint32_t> edge_points_;
  std::vector<std::uint32_t> used_;
  std::uint64_t tetrahedra_ = 0;
  int greatest_class_at_lost_ = 0;
};

/// The contour of the mesh in which nothing is split. Throws PageLost.
template <class Sample>
Contour root_contour(StoredDiamonds<Sample>& diamonds, double isovalue, const ContourOptions& options) {
  const Diamond root = diamonds.root();
  ContourBuilder builder(diamonds.domain(), isovalue, options);
  DiamondContour(builder, isovalue, options.last_sample)
      .add(root, (1u << root.tetrahedron_count()) - 1, [&](LatticePoint p) { return diamonds.sample(p); });
  return builder.finish();
}

extern template class PageContour<std::uint8_t>;
extern template class PageContour<std::uint16_t>;
extern template class PageContour<std::int16_t>;
extern template class PageContour<float>;

}  // namespace adamas::isosurface
