#include "isosurface/extraction/page_box.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace adamas::isosurface {

template <class Sample>
void PageBox<Sample>::load(LatticePoint block) {
  using Side = typename StoredDiamonds<Sample>::Side;
  block_ = block;
  const PageGrid& grid = diamonds_.grid();
  const LatticePoint blocks = grid.blocks(0), last = grid.last();
  for (int axis = 0; axis < 3; ++axis)
    cells_[axis] = std::clamp(last[axis] - PageGrid::kSide * block[axis], 0, PageGrid::kSide);
  // For pages that the contour does not cross, their side is enough, except for the corners of crossed cells
  // of this page.
  std::array<LatticePoint, 26> guessed;
  std::size_t guesses = 0;
  for (int n = 0; n < 27; ++n) {
    const LatticePoint step = step_around(n), at = block + step;
    if (!is_below(at, blocks)) continue;
    const Side side = step == LatticePoint{} ? Side::kBoth : diamonds_.side({0, at});
    if (side == Side::kBoth) {
      copy(step);
    } else {
      fill(step, static_cast<Word>(diamonds_.least_above() - (side == Side::kAbove ? 0 : 1)));
      if (std::min({step.i, step.j, step.k}) >= 0) guessed[guesses++] = step;
    }
  }
  find_above();
  for (std::size_t n = 0; n < guesses; ++n) {
    if (has_crossed_cells_at(guessed[n])) copy(guessed[n]);
  }
  is_finite_ = true;
  if constexpr (std::is_floating_point_v<Sample>) find_finite();
}

/// Checks only the samples of the data.
template <class Sample>
void PageBox<Sample>::find_finite() {
  const LatticePoint last = diamonds_.grid().last();
  std::array<std::int32_t, 3> begin{}, end{};
  for (int axis = 0; axis < 3; ++axis) {
    begin[static_cast<std::size_t>(axis)] = block_[axis] == 0 ? 0 : kFirst;
    end[static_cast<std::size_t>(axis)] = std::min(kLast, last[axis] - PageGrid::kSide * block_[axis]);
  }
  for (std::int32_t k = begin[2]; k <= end[2]; ++k) {
    for (std::int32_t j = begin[1]; j <= end[1]; ++j) {
      for (std::int32_t i = begin[0]; i <= end[0]; ++i)
        is_finite_ = is_finite_ && std::isfinite(from_ordered<Sample>(words_[place({i, j, k})]));
    }
  }
}

template <class Sample>
void PageBox<Sample>::copy(LatticePoint step) {
  const PageSamples<Word>& page = diamonds_.pages().needed_samples({0, block_ + step});
  const Run i(step.i), j(step.j), k(step.k);
  for (std::int32_t z = k.first; z < k.first + k.count; ++z) {
    for (std::int32_t y = j.first; y < j.first + j.count; ++y) {
      const Word* from = page.samples.data() + PageGrid::place({i.first, y, z}, 0);
      std::copy_n(from, i.count, words_.data() + place({i.first, y, z}));
    }
  }
}

template <class Sample>
void PageBox<Sample>::fill(LatticePoint step, Word word) {
  const Run i(step.i), j(step.j), k(step.k);
  for (std::int32_t z = k.first; z < k.first + k.count; ++z) {
    for (std::int32_t y = j.first; y < j.first + j.count; ++y)
      std::fill_n(words_.data() + place({i.first, y, z}), i.count, word);
  }
}

template <class Sample>
void PageBox<Sample>::find_above() {
  const std::uint64_t least = diamonds_.least_above();
  for (std::size_t row = 0; row < above_.size(); ++row) {
    const Word* words = words_.data() + static_cast<std::size_t>(kSide) * row;
    std::uint32_t bits = 0;
    for (std::int32_t n = 0; n < kSide; ++n) bits |= (words[n] >= least ? 1u : 0u) << n;
    above_[row] = bits;
  }
}

template <class Sample>
std::uint32_t PageBox<Sample>::crossed_cells(std::int32_t j, std::int32_t k) const {
  if (j >= cells_.j || k >= cells_.k) return 0;
  std::uint32_t any = 0, all = ~0u;
  for (const std::uint32_t bits : {above(j, k), above(j + 1, k), above(j, k + 1), above(j + 1, k + 1)}) {
    any |= bits | bits >> 1;
    all &= bits & bits >> 1;
  }
  return (any & ~all) >> -kFirst & ((1u << cells_.i) - 1);
}

/// Returns whether the contour crosses cells of the page that have corners on a page behind it.
template <class Sample>
bool PageBox<Sample>::has_crossed_cells_at(LatticePoint step) const {
  constexpr std::int32_t kEnd = PageGrid::kSide - 1;
  const std::uint32_t in_row = step.i > 0 ? 1u << kEnd : 0xffffu;
  for (std::int32_t k = step.k > 0 ? kEnd : 0; k <= kEnd; ++k) {
    for (std::int32_t j = step.j > 0 ? kEnd : 0; j <= kEnd; ++j) {
      if ((crossed_cells(j, k) & in_row) != 0) return true;
    }
  }
  return false;
}

template class PageBox<std::uint8_t>;
template class PageBox<std::uint16_t>;
template class PageBox<std::int16_t>;
template class PageBox<float>;

}  // namespace adamas::isosurface
