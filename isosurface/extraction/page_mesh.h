#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <type_traits>
#include <utility>

#include "core/geometry/tetrahedron_contour.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/page_diamonds.h"

namespace adamas::isosurface {

/// The tetrahedra of a mesh that come from splitting diamonds of one page, and the triangles of the contour
/// in them. No table of the mesh is needed: the two halves into which a split bisects a tetrahedron belong to
/// child diamonds, and are in the mesh if these are not split, which the masks of split diamonds on this page
/// and on those round it tell. The coarsest page of a store counts as one page for each of its LODs.
template <class Sample>
class PageMesh {
 public:
  /// Returns the split diamonds of a page of an LOD; null where nothing is split.
  using SplitOf = std::function<const PageMask*(int lod, LatticePoint block)>;
  /// The edges of the mesh that a triangle's points lie on: DiamondStencil::edge_place of the sums of their
  /// ends, which are counted from one step before the page's first point on.
  using EdgePlaces = std::array<std::int32_t, 3>;

  /// Makes the object. The diamonds must outlive it.
  PageMesh(StoredDiamonds<Sample>& diamonds, SplitOf split_of)
      : diamonds_(diamonds), split_of_(std::move(split_of)), page_(diamonds) {}

  /// Goes to a page, and copies the samples of some of its diamonds. Throws PageLost.
  void load(int lod, LatticePoint block, const PageMask& wanted) {
    page_.load(lod, block, wanted);
    same_ = {.lod = lod, .block = block};
    // A page has eight next finer ones, except that the coarsest page has all coarser LODs too.
    finer_ = {.lod = lod - 1, .block = (lod > diamonds_.grid().top() ? 1 : 2) * block};
  }
  /// Returns the samples of load().
  [[nodiscard]] const PageDiamonds<Sample>& samples() const { return page_; }

  /// Calls visit(edges, is_cut) for the triangles in the tetrahedra that come from splitting a diamond, whose
  /// samples were loaded. `is_cut`: whether the tetrahedron extends beyond the data.
  template <class Visit>
  void for_each_triangle(LatticePoint q, Visit&& visit);

 private:
  /// The masks of the pages round a block, in the order of step_around(); each is looked up once, at its
  /// first use.
  struct Neighbours {
    int lod = 0;
    LatticePoint block{};
    std::uint32_t known = 0;  ///< masks that were looked up, as bits
    std::array<const PageMask*, 27> split{};
  };

  void find_split(std::size_t n, Neighbours& neighbours) const {
    neighbours.known |= 1u << n;
    neighbours.split[n] = split_of_(neighbours.lod, neighbours.block + step_around(static_cast<int>(n)));
  }
  /// Returns whether a child is split, given its point in units of the LOD of `pages`.
  [[nodiscard]] bool is_split(LatticePoint child, Neighbours& pages) const {
    const std::size_t n = page_around(child);
    if ((pages.known >> n & 1) == 0) find_split(n, pages);
    constexpr std::int32_t kInPage = PageGrid::kSide - 1;
    const PageMask* const split = pages.split[n];
    return split != nullptr && split->has({child.i & kInPage, child.j & kInPage, child.k & kInPage});
  }
  template <class Visit>
  void visit_half(const DiamondStencil& stencil, LatticePoint q, const DiamondStencil::Half& half,
                  DiamondStencil::Members above, Visit&& visit) const;

  StoredDiamonds<Sample>& diamonds_;
  SplitOf split_of_;
  PageDiamonds<Sample> page_;
  Neighbours same_, finer_;  ///< pages of the page's LOD, and of the next finer one
};

template <class Sample>
template <class Visit>
void PageMesh<Sample>::for_each_triangle(LatticePoint q, Visit&& visit) {
  const DiamondStencil& stencil = DiamondStencil::at(q);
  const DiamondStencil::Members above = page_.above(stencil, q);
  const unsigned slots = page_.slots(stencil, q);
  // Children of phase 2 are points of the next finer LOD.
  const bool is_finer = stencil.phase == 2;
  for (unsigned crossed = stencil.crossed[above]; crossed != 0;) {
    const auto c = static_cast<std::size_t>(std::countr_zero(crossed)) / 2;
    const unsigned halves = crossed & 3u << 2 * c;
    crossed &= ~halves;
    const LatticePoint child = (is_finer ? 2 : 1) * q + stencil.children[c];
    if (is_split(child, is_finer ? finer_ : same_)) continue;
    if (!page_.is_inside() && !diamonds_.reaches_data(page_.diamond(q).child(static_cast<int>(c)))) continue;
    for (std::size_t n = 2 * c; n < 2 * c + 2; ++n) {
      const DiamondStencil::Half& half = stencil.halves[n];
      if ((halves >> n & 1) != 0 && (slots >> half.slot & 1) != 0) visit_half(stencil, q, half, above, visit);
    }
  }
}

template <class Sample>
template <class Visit>
void PageMesh<Sample>::visit_half(const DiamondStencil& stencil, LatticePoint q,
                                  const DiamondStencil::Half& half, DiamondStencil::Members above,
                                  Visit&& visit) const {
  unsigned bits = 0;
  for (std::size_t v = 0; v < 4; ++v) bits |= (above >> half.vertices[v] & 1) << v;
  bool is_cut = false;
  if (std::is_floating_point_v<Sample> || !page_.is_inside()) {
    std::array<LatticePoint, 4> in_lattice;
    for (std::size_t v = 0; v < 4; ++v) {
      const LatticePoint p = q + stencil.offsets[half.vertices[v]];
      if (std::is_floating_point_v<Sample> && !std::isfinite(page_.value(p))) return;
      in_lattice[v] = page_.in_lattice(p);
    }
    const LatticePoint last = diamonds_.last_sample();
    if (is_beyond(in_lattice, last)) return;
    is_cut = reaches_beyond(in_lattice, last);
  }
  const TetrahedronContour& contour = kTetrahedronContours[bits];
  const std::int32_t middle = DiamondStencil::edge_place(2 * (q + LatticePoint{1, 1, 1}));
  for (std::size_t n = 0; n < contour.triangle_count; ++n) {
    EdgePlaces triangle;
    for (std::size_t c = 0; c < 3; ++c) triangle[c] = middle + half.edges[contour.triangles[n][c]];
    visit(triangle, is_cut);
  }
}

/// Returns the contour of the mesh in which nothing is split. Throws PageLost.
template <class Sample>
Contour root_contour(StoredDiamonds<Sample>& diamonds, double isovalue, const ContourOptions& options) {
  const Diamond root = diamonds.root();
  ContourBuilder builder(diamonds.domain(), isovalue, options);
  DiamondContour(builder, isovalue, options.last_sample)
      .add(root, (1u << root.tetrahedron_count()) - 1, [&](LatticePoint p) { return diamonds.sample(p); });
  return builder.finish();
}

}  // namespace adamas::isosurface
