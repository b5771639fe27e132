#include "isosurface/extraction/page_diamonds.h"

#include <algorithm>
#include <cmath>

namespace adamas {

namespace {

constexpr std::int32_t kLast = PageGrid::kSide - 1;

bool is_in_page(LatticePoint q) {
  return std::min({q.i, q.j, q.k}) >= 0 && std::max({q.i, q.j, q.k}) <= kLast;
}

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
  const bool has_page = level <= diamonds_.grid().top();
  if (has_page) {
    const auto& samples = diamonds_.marked_page({level, block}).samples;
    for (std::int32_t k = 0; k <= kLast; ++k) {
      for (std::int32_t j = 0; j <= kLast; ++j)
        std::copy_n(samples.data() + PageGrid::place({0, j, k}, 0), PageGrid::kSide, words_.at({0, j, k}));
    }
  }
  known_neighbours_ = 0;
  finite_ = true;
  split.for_each([&](LatticePoint q) {
    // Of coarser levels than the coarsest page's own no page has the points side by side.
    const bool near_border =
        !has_page || !inside_ || std::min({q.i, q.j, q.k}) == 0 || std::max({q.i, q.j, q.k}) == kLast;
    if (near_border) get_outside(q);
    if constexpr (std::is_floating_point_v<Sample>) {
      const DiamondStencil& stencil = DiamondStencil::at(q);
      for (std::size_t m = 0; m < stencil.count; ++m)
        finite_ = finite_ && std::isfinite(value(q + stencil.offsets[m]));
    }
  });
}

template <class Sample>
bool PageDiamonds<Sample>::get_from_neighbour(LatticePoint q) {
  const LatticePoint step{q.i >> 4, q.j >> 4, q.k >> 4};
  const auto n = static_cast<std::size_t>(step.i + 1 + 3 * (step.j + 1) + 9 * (step.k + 1));
  if ((known_neighbours_ >> n & 1) == 0) {
    neighbours_[n] = diamonds_.held_page({level_, block_ + step});
    known_neighbours_ |= 1u << n;
  }
  if (neighbours_[n] == nullptr) return false;
  *words_.at(q) = neighbours_[n]->samples[PageGrid::place(q, 0)];
  return true;
}

template <class Sample>
void PageDiamonds<Sample>::get_outside(LatticePoint q) {
  const DiamondStencil& stencil = DiamondStencil::at(q);
  const LatticePoint extent = diamonds_.grid().extent(level_);
  const bool has_page = level_ <= diamonds_.grid().top();
  for (std::size_t m = 0; m < stencil.count; ++m) {
    const LatticePoint at = q + stencil.offsets[m], u = corner_ + at;
    const bool in_page = is_in_page(at);
    if (in_page && inside_ && has_page) continue;
    const bool is_on_page =
        has_page && std::min({u.i, u.j, u.k}) >= 0 && u.i <= extent.i && u.j <= extent.j && u.k <= extent.k;
    if (is_on_page && (in_page || get_from_neighbour(at))) continue;
    // Vertices outside the domain are none of the mesh.
    if (!diamonds_.domain().contains(in_lattice(at))) {
      *words_.at(at) = static_cast<Word>(ordered(Sample{0}));
      continue;
    }
    *words_.at(at) = diamonds_.word(in_samples(at));
    known_neighbours_ = 0;
  }
}

template class PageDiamonds<std::uint8_t>;
template class PageDiamonds<std::uint16_t>;
template class PageDiamonds<std::int16_t>;
template class PageDiamonds<float>;

}  // namespace adamas
