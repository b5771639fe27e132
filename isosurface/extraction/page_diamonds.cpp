#include "isosurface/extraction/page_diamonds.h"

#include <algorithm>
#include <cmath>

namespace adamas {

namespace {

constexpr std::int32_t kLast = PageGrid::kSide - 1;

/// The page that has a point, from -1 to 1 pages away along each axis, as a bit.
std::uint32_t bit_of_page(LatticePoint q) {
  return 1u << static_cast<unsigned>((q.i >> 4) + 1 + 3 * ((q.j >> 4) + 1) + 9 * ((q.k >> 4) + 1));
}
constexpr std::uint32_t kOwnPage = 1u << 13, kAllPages = (1u << 27) - 1;

}  // namespace

template <class Sample>
void PageDiamonds<Sample>::load(int level, LatticePoint block, const PageMask& split) {
  level_ = level;
  block_ = block;
  corner_ = PageGrid::kSide * block;
  lattice_step_ = diamonds_.lattice_step(level);
  const LatticePoint last = diamonds_.grid().last();
  inside_ = true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t end = std::int64_t{corner_[axis] + PageGrid::kSide} << level;
    inside_ = inside_ && block[axis] > 0 && end <= last[axis];
  }
  known_ = 0;
  // Of coarser levels than the coarsest page's own no page has the points side by side.
  if (level <= diamonds_.grid().top()) {
    const auto& samples = diamonds_.page({level, block}).samples;
    for (std::int32_t k = 0; k <= kLast; ++k) {
      for (std::int32_t j = 0; j <= kLast; ++j)
        std::copy_n(samples.data() + PageGrid::place({0, j, k}, 0), PageGrid::kSide, words_.at({0, j, k}));
    }
    known_ = kOwnPage;
    get_from_neighbours();
  }
  finite_ = true;
  const bool is_all_there = inside_ && known_ == kAllPages;
  if (is_all_there && !std::is_floating_point_v<Sample>) return;
  split.for_each([&](LatticePoint q) {
    const bool near_border =
        !inside_ || known_ == 0 || std::min({q.i, q.j, q.k}) == 0 || std::max({q.i, q.j, q.k}) == kLast;
    if (near_border && !is_all_there) get_others(q);
    if constexpr (std::is_floating_point_v<Sample>) {
      const DiamondStencil& stencil = DiamondStencil::at(q);
      for (std::size_t m = 0; m < stencil.count; ++m)
        finite_ = finite_ && std::isfinite(value(q + stencil.offsets[m]));
    }
  });
}

template <class Sample>
void PageDiamonds<Sample>::get_from_neighbours() {
  const LatticePoint blocks = diamonds_.grid().blocks(level_);
  for (std::int32_t n = 0; n < 27; ++n) {
    const LatticePoint step{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}, block = block_ + step;
    if (step == LatticePoint{} || std::min({block.i, block.j, block.k}) < 0 || block.i >= blocks.i ||
        block.j >= blocks.j || block.k >= blocks.k)
      continue;
    const Page<Word>* page = diamonds_.held_page({level_, block});
    if (page == nullptr) continue;
    known_ |= 1u << n;
    // One plane of the page, one edge or one corner.
    LatticePoint first, last;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = step[axis] < 0 ? -1 : step[axis] > 0 ? PageGrid::kSide : 0;
      last[axis] = step[axis] == 0 ? kLast : first[axis];
    }
    for (std::int32_t k = first.k; k <= last.k; ++k) {
      for (std::int32_t j = first.j; j <= last.j; ++j) {
        const Word* from = page->samples.data() + PageGrid::place({first.i, j, k}, 0);
        Word* to = words_.at({first.i, j, k});
        if (step.i == 0) {
          std::copy_n(from, PageGrid::kSide, to);
        } else {
          *to = *from;
        }
      }
    }
  }
}

template <class Sample>
bool PageDiamonds<Sample>::is_there(LatticePoint q) const {
  if ((known_ & bit_of_page(q)) == 0) return false;
  const LatticePoint u = corner_ + q, extent = diamonds_.grid().extent(level_);
  return u.i <= extent.i && u.j <= extent.j && u.k <= extent.k;
}

template <class Sample>
void PageDiamonds<Sample>::get_others(LatticePoint q) {
  const DiamondStencil& stencil = DiamondStencil::at(q);
  for (std::size_t m = 0; m < stencil.count; ++m) {
    const LatticePoint at = q + stencil.offsets[m];
    if (is_there(at)) continue;
    // Vertices outside the domain are none of the mesh.
    const bool is_vertex = diamonds_.domain().contains(in_lattice(at));
    *words_.at(at) = is_vertex ? diamonds_.word(in_samples(at)) : static_cast<Word>(ordered(Sample{0}));
  }
}

template class PageDiamonds<std::uint8_t>;
template class PageDiamonds<std::uint16_t>;
template class PageDiamonds<std::int16_t>;
template class PageDiamonds<float>;

}  // namespace adamas
