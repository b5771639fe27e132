#include "isosurface/extraction/page_contour.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

namespace adamas::isosurface {

namespace {

constexpr std::uint32_t kNone = ContourBuilder::kNone;

/// Which page along an axis a coordinate is on, from one page before to one behind: -1 to 1.
std::int32_t page_of(std::int32_t x) { return x >> 4; }
std::size_t neighbour(LatticePoint q) {
  return static_cast<std::size_t>((page_of(q.i) + 1) + 3 * (page_of(q.j) + 1) + 9 * (page_of(q.k) + 1));
}
std::int32_t in_page(std::int32_t x) { return x & (PageGrid::kSide - 1); }

}  // namespace

template <class Sample>
PageContour<Sample>::PageContour(StoredDiamonds<Sample>& diamonds, const SplitPages<Sample>& pages,
                                 const SplitLimits& limits, ContourBuilder& builder)
    : diamonds_(diamonds),
      split_pages_(pages),
      limits_(limits),
      builder_(builder),
      page_(diamonds),
      edge_points_(static_cast<std::size_t>(DiamondStencil::edge_place({0, 0, DiamondStencil::kEdgeSide})),
                   kNone) {}

template <class Sample>
typename PageContour<Sample>::Neighbours PageContour<Sample>::neighbours(int lod, LatticePoint block) const {
  Neighbours found{};
  for (std::int32_t dk = -1; dk <= 1; ++dk) {
    for (std::int32_t dj = -1; dj <= 1; ++dj) {
      for (std::int32_t di = -1; di <= 1; ++di) {
        const PageOfLod* page = split_pages_.page(lod, block + LatticePoint{di, dj, dk});
        if (page == nullptr) continue;
        found[neighbour(PageGrid::kSide * LatticePoint{di, dj, dk})] = page->split;
      }
    }
  }
  return found;
}

template <class Sample>
void PageContour<Sample>::add(int lod, const PageOfLod& page) {
  const PageMask& split = *page.split;
  page_.load(lod, page.block, split);
  same_ = neighbours(lod, page.block);
  // A page has eight next finer ones, except that the coarsest page has all coarser LODs too.
  const bool is_same_page = lod > diamonds_.grid().top();
  finer_ = neighbours(lod - 1, (is_same_page ? 1 : 2) * page.block);
  split.for_each([&](LatticePoint q) { add_diamond(DiamondStencil::at(q), q); });
  forget_edge_points();
}

template <class Sample>
void PageContour<Sample>::add_diamond(const DiamondStencil& stencil, LatticePoint q) {
  const Members above = page_.above(stencil, q);
  const unsigned slots = page_.slots(stencil, q);
  tetrahedra_ +=
      page_.is_inside() ? stencil.tetrahedron_count : static_cast<std::size_t>(std::popcount(slots));
  if (!limits_.lost.empty()) note_lost_children(page_.diamond(q));
  // Children of phase 2 are points of the next finer LOD.
  const bool finer = stencil.phase == 2;
  const Neighbours& pages = finer ? finer_ : same_;
  for (unsigned crossed = stencil.crossed[above]; crossed != 0; crossed &= crossed - 1) {
    const auto n = static_cast<std::size_t>(std::countr_zero(crossed));
    const DiamondStencil::Half& half = stencil.halves[n];
    if ((slots >> half.slot & 1) == 0) continue;
    const LatticePoint child = (finer ? 2 : 1) * q + stencil.children[n / 2];
    const PageMask* split = pages[neighbour(child)];
    if (split != nullptr && split->has({in_page(child.i), in_page(child.j), in_page(child.k)})) continue;
    if (page_.is_inside() || split_pages_.is_in_data(page_.diamond(q).child(static_cast<int>(n / 2))))
      add_half(stencil, q, half, above);
  }
}

template <class Sample>
void PageContour<Sample>::note_lost_children(const Diamond& diamond) {
  for (int c = 0; c < diamond.child_count(); ++c) {
    // What cannot be had has no greater error than what it comes from.
    const LatticePoint child = diamond.child(c);
    if (split_pages_.is_in_data(child) && split_pages_.is_lost(child))
      greatest_class_at_lost_ =
          std::max(greatest_class_at_lost_, diamonds_.class_if_crossed(diamond.point()));
  }
}

template <class Sample>
void PageContour<Sample>::add_half(const DiamondStencil& stencil, LatticePoint q,
                                   const DiamondStencil::Half& half, Members above) {
  unsigned bits = 0;
  for (std::size_t v = 0; v < 4; ++v) bits |= (above >> half.vertices[v] & 1) << v;
  if (std::is_floating_point_v<Sample> || !page_.is_inside()) {
    std::array<LatticePoint, 4> in_lattice;
    for (std::size_t v = 0; v < 4; ++v) {
      const LatticePoint p = q + stencil.offsets[half.vertices[v]];
      if (std::is_floating_point_v<Sample> && !std::isfinite(page_.value(p))) return;
      in_lattice[v] = page_.in_lattice(p);
    }
    if (!page_.is_inside() && is_beyond(in_lattice, diamonds_.last_sample())) return;
  }
  const TetrahedronContour& contour = kTetrahedronContours[bits];
  const std::int32_t middle = DiamondStencil::edge_place(2 * (q + LatticePoint{1, 1, 1}));
  for (std::size_t n = 0; n < contour.triangle_count; ++n) {
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint8_t edge = contour.triangles[n][c];
      const auto at = static_cast<std::uint32_t>(middle + half.edges[edge]);
      std::uint32_t& point = edge_points_[at];
      if (point == kNone) {
        const auto [a, b] = kTetrahedronEdges[edge];
        point = edge_point(q + stencil.offsets[half.vertices[a]], q + stencil.offsets[half.vertices[b]]);
        used_.push_back(at);
      }
      triangle[c] = point;
    }
    builder_.add_triangle(triangle);
  }
}

template <class Sample>
std::uint32_t PageContour<Sample>::edge_point(LatticePoint a, LatticePoint b) {
  return builder_.edge_point(page_.in_lattice(a), page_.in_lattice(b), page_.value(a), page_.value(b));
}

template <class Sample>
void PageContour<Sample>::forget_edge_points() {
  for (const std::uint32_t at : used_) edge_points_[at] = kNone;
  used_.clear();
}

template class PageContour<std::uint8_t>;
template class PageContour<std::uint16_t>;
template class PageContour<std::int16_t>;
template class PageContour<float>;

}  // namespace adamas::isosurface
