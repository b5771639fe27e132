#include "isosurface/extraction/page_diamonds.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kLast = PageGrid::kSide - 1;

constexpr std::uint32_t kOwnPage = 1u << 13, kAllPages = (1u << 27) - 1;

/// The pages at a step from -1 to 1 along an axis, as bits; indexed by axis and step.
constexpr auto kPagesAt = [] {
  std::array<std::array<std::uint32_t, 3>, 3> pages{};
  for (unsigned n = 0; n < 27; ++n) {
    pages[0][n % 3] |= 1u << n;
    pages[1][n / 3 % 3] |= 1u << n;
    pages[2][n / 9] |= 1u << n;
  }
  return pages;
}();

/// Returns the pages that have the points from one before a coordinate to one behind it, as bits.
constexpr std::uint32_t pages_round(std::int32_t x, std::size_t axis) {
  const auto& [before, own, behind] = kPagesAt[axis];
  return own | (x == 0 ? before : 0) | (x == kLast ? behind : 0);
}

/// Returns the pages that have members of a page's diamonds, as bits.
std::uint32_t pages_touched(const PageMask& split) {
  const auto& [before, own, behind] = kPagesAt[0];
  std::uint32_t pages = 0;
  for (std::int32_t k = 0; k <= kLast; ++k) {
    for (std::int32_t j = 0; j <= kLast; ++j) {
      const unsigned row = split.rows[static_cast<std::size_t>(j + PageGrid::kSide * k)];
      if (row == 0) continue;
      const std::uint32_t along_i = own | ((row & 1) != 0 ? before : 0) | (row >> kLast != 0 ? behind : 0);
      pages |= along_i & pages_round(j, 1) & pages_round(k, 2);
    }
  }
  return pages;
}

}  // namespace

template <class Sample>
void PageDiamonds<Sample>::load(int lod, LatticePoint block, const PageMask& split) {
  lod_ = lod;
  block_ = block;
  corner_ = PageGrid::kSide * block;
  lattice_step_ = diamonds_.lattice_step(lod);
  const LatticePoint last = diamonds_.grid().last();
  inside_ = true;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t end = std::int64_t{corner_[axis] + PageGrid::kSide} << lod;
    inside_ = inside_ && block[axis] > 0 && end <= last[axis];
  }
  known_ = known_coarser_ = 0;
  // No page of an LOD that is coarser than the coarsest page's own has the points side by side.
  if (lod <= diamonds_.grid().top()) {
    const PagePoints<Word>& samples = diamonds_.pages().needed_samples({lod, block}).samples;
    for (std::int32_t k = 0; k <= kLast; ++k) {
      for (std::int32_t j = 0; j <= kLast; ++j)
        std::copy_n(samples.data() + PageGrid::place({0, j, k}, 0), PageGrid::kSide, words_.at({0, j, k}));
    }
    known_ = kOwnPage;
    get_from_neighbours(pages_touched(split));
  }
  reaching_others(split).for_each([this](LatticePoint q) { get_others(q); });
  finite_ = true;
  if constexpr (std::is_floating_point_v<Sample>) {
    split.for_each([this](LatticePoint q) {
      const DiamondStencil& stencil = DiamondStencil::at(q);
      for (std::size_t m = 0; m < stencil.count; ++m)
        finite_ = finite_ && std::isfinite(value(q + stencil.offsets[m]));
    });
  }
}

template <class Sample>
PageMask PageDiamonds<Sample>::reaching_others(const PageMask& split) const {
  // If the data end on or before the page, not all of its points and of those round it exist.
  const LatticePoint end = diamonds_.grid().extent(lod_);
  for (int axis = 0; axis < 3; ++axis) {
    if (corner_[axis] + PageGrid::kSide > end[axis]) return split;
  }
  PageMask found;
  const std::uint32_t missing = kAllPages & ~known_;
  for (std::int32_t k = 0; k <= kLast; ++k) {
    for (std::int32_t j = 0; j <= kLast; ++j) {
      const std::uint32_t in_row = missing & pages_round(j, 1) & pages_round(k, 2);
      unsigned reaching = 0;
      if ((in_row & pages_round(0, 0)) != 0) reaching |= 1;
      if ((in_row & pages_round(kLast, 0)) != 0) reaching |= 1u << kLast;
      if ((in_row & pages_round(1, 0)) != 0) reaching = 0xffff;
      const auto row = static_cast<std::size_t>(j + PageGrid::kSide * k);
      found.rows[row] = static_cast<std::uint16_t>(split.rows[row] & reaching);
    }
  }
  return found;
}

template <class Sample>
void PageDiamonds<Sample>::get_from_neighbours(std::uint32_t pages) {
  const LatticePoint blocks = diamonds_.grid().blocks(lod_);
  for (pages &= ~kOwnPage; pages != 0; pages &= pages - 1) {
    const int n = std::countr_zero(pages);
    const LatticePoint step = step_around(n), block = block_ + step;
    if (!is_below(block, blocks)) continue;
    const PageSamples<Word>* page = diamonds_.pages().held({lod_, block});
    if (page == nullptr) {
      get_coarser(step);
      continue;
    }
    known_ |= 1u << n;
    // These points are one plane of the page, one edge or one corner.
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
void PageDiamonds<Sample>::get_coarser(LatticePoint step) {
  // The points one before the page are odd, so they belong to no coarser LOD.
  if (std::min({step.i, step.j, step.k}) < 0 || lod_ == diamonds_.grid().top()) return;
  const LatticePoint block = block_ + step;
  const PageSamples<Word>* page = diamonds_.pages().held({lod_ + 1, {block.i / 2, block.j / 2, block.k / 2}});
  if (page == nullptr) return;
  known_coarser_ |= 1u << page_around(PageGrid::kSide * step);
  const LatticePoint first = PageGrid::kSide * step;
  const auto end = [&](int axis) { return step[axis] > 0 ? first[axis] : kLast; };
  for (LatticePoint q = first; q.k <= end(2); q.k += 2) {
    for (q.j = first.j; q.j <= end(1); q.j += 2) {
      for (q.i = first.i; q.i <= end(0); q.i += 2) {
        const LatticePoint u = corner_ + q;
        *words_.at(q) = page->samples[PageGrid::place({u.i / 2, u.j / 2, u.k / 2}, 0)];
      }
    }
  }
}

template <class Sample>
bool PageDiamonds<Sample>::is_there(LatticePoint q) const {
  const LatticePoint u = corner_ + q;
  const auto is_within = [u](LatticePoint extent, int step) {
    return u.i <= step * extent.i && u.j <= step * extent.j && u.k <= step * extent.k;
  };
  const std::uint32_t page = 1u << page_around(q);
  if ((known_ & page) != 0) return is_within(diamonds_.grid().extent(lod_), 1);
  return (known_coarser_ & page) != 0 && ((q.i | q.j | q.k) & 1) == 0 &&
         is_within(diamonds_.grid().extent(lod_ + 1), 2);
}

template <class Sample>
void PageDiamonds<Sample>::get_others(LatticePoint q) {
  const DiamondStencil& stencil = DiamondStencil::at(q);
  for (std::size_t m = 0; m < stencil.count; ++m) {
    const LatticePoint at = q + stencil.offsets[m];
    if (is_there(at)) continue;
    // Vertices outside the domain are not in the mesh.
    const bool is_vertex = diamonds_.domain().contains(in_lattice(at));
    *words_.at(at) = is_vertex ? diamonds_.word(in_samples(at)) : static_cast<Word>(ordered(Sample{0}));
  }
}

ADAMAS_INSTANTIATE_FOR_SAMPLES(PageDiamonds);

}  // namespace adamas::isosurface
