#include "isosurface/storage/page_tree.h"

#include <algorithm>
#include <array>

#include "core/base/assert.h"
#include "isosurface/compression/eight_lanes.h"

namespace adamas {

namespace {

/// Where along an axis the 11 places of Surroundings lie in the pages of the next coarser level.
struct AxisPlaces {
  std::array<std::int32_t, 2> blocks{};
  int block_count = 0;
  std::array<std::uint8_t, Surroundings<std::uint8_t>::kSide> place{};
  /// Those in each block: the first, how many, and whether their places follow each other.
  struct Run {
    std::size_t first = 0, count = 0;
    bool is_run = true;
  };
  std::array<Run, 2> runs{};

  AxisPlaces(std::int32_t block, std::int32_t extent) {
    for (std::int32_t c = 0; c < Surroundings<std::uint8_t>::kSide; ++c) {
      const std::int32_t at = std::clamp(8 * block + c - 1, 0, extent);
      const std::int32_t parent = at / PageGrid::kSide;
      if (block_count == 0 || blocks[static_cast<std::size_t>(block_count - 1)] != parent)
        blocks[static_cast<std::size_t>(block_count++)] = parent;
      place[static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(at % PageGrid::kSide);
      Run& run = runs[static_cast<std::size_t>(block_count - 1)];
      if (run.count == 0) run.first = static_cast<std::size_t>(c);
      run.is_run = run.is_run && place[static_cast<std::size_t>(c)] == place[run.first] + run.count;
      ++run.count;
    }
  }
};

/// Of a page round which something is: the part of Surroundings that one page of the next coarser level has.
struct Part {
  const AxisPlaces &x, &y, &z;
  std::array<int, 3> blocks;  ///< which of those of the axes
};

/// Copies what is known of it, for rows of N points side by side; of any, one by one, where N is 0.
template <std::size_t N, PageParts Parts, class Word>
void copy_part(const Part& part, const Page<Word>& page, Surroundings<Word>& around) {
  constexpr std::size_t kSide = Surroundings<Word>::kSide;
  const auto run = [&part](const AxisPlaces& places, std::size_t axis) {
    return places.runs[static_cast<std::size_t>(part.blocks[axis])];
  };
  const AxisPlaces::Run xs = run(part.x, 0), ys = run(part.y, 1), zs = run(part.z, 2);
  const auto copy = [&](const auto& from, auto& to) {
    for (std::size_t k = zs.first; k < zs.first + zs.count; ++k) {
      for (std::size_t j = ys.first; j < ys.first + ys.count; ++j) {
        const auto* row = from.data() + PageGrid::kSide * (part.y.place[j] +
                                                           std::size_t{PageGrid::kSide} * part.z.place[k]);
        auto* at = to.data() + kSide * (j + kSide * k);
        if constexpr (N > 0) {
          std::copy_n(row + part.x.place[xs.first], N, at + xs.first);
        } else {
          for (std::size_t c = xs.first; c < xs.first + xs.count; ++c) at[c] = row[part.x.place[c]];
        }
      }
    }
  };
  copy(page.samples, around.samples);
  if constexpr (Parts == PageParts::kAll) {
    copy(page.low, around.low);
    copy(page.high, around.high);
    copy(page.errors, around.errors);
  }
}

template <PageParts Parts, class Word>
void copy_part(const Part& part, const Page<Word>& page, Surroundings<Word>& around) {
  // Away from the data's ends the numbers of points are these, and they lie side by side.
  const AxisPlaces::Run xs = part.x.runs[static_cast<std::size_t>(part.blocks[0])];
  if (xs.is_run && xs.count == 1) return copy_part<1, Parts>(part, page, around);
  if (xs.is_run && xs.count == 2) return copy_part<2, Parts>(part, page, around);
  if (xs.is_run && xs.count == 9) return copy_part<9, Parts>(part, page, around);
  if (xs.is_run && xs.count == 10) return copy_part<10, Parts>(part, page, around);
  copy_part<0, Parts>(part, page, around);
}

}  // namespace

template <class Word>
PageTree<Word>::PageTree(const PageGrid& grid, PageParts parts, std::size_t capacity, Loader loader)
    : grid_(grid), parts_(parts), capacity_(std::max(capacity, kLeast)), loader_(std::move(loader)) {
  for (int level = 0; level <= grid_.top(); ++level) {
    const LatticePoint n = grid_.blocks(level);
    const auto row = static_cast<std::size_t>(n.i), plane = row * static_cast<std::size_t>(n.j);
    levels_.push_back({row, plane, std::vector<std::uint32_t>(plane * static_cast<std::size_t>(n.k), kNone)});
  }
}

template <class Word>
const Page<Word>* PageTree<Word>::page(const PageId& id, bool wanted) {
  const std::uint32_t found = slot_of(id);
  if (found != kNone) {
    Slot& slot = slots_[found];
    if (wanted && !slot.wanted) {
      slot.wanted = true;
      --predictors_;
    }
    slot.used = true;
    return slot.page;
  }
  Surroundings<Word> around;
  if (!surroundings(id, around)) return nullptr;
  // Not before: what predicts the page may have pushed others out.
  const std::uint32_t fresh = free_slot();
  Slot& slot = slots_[fresh];
  const PageShape shape = page_shape(grid_, id);
  if (!shape.complete) fill_coarser(shape, around, *slot.page);
  // A cube whose only point is a coarser one has no page.
  if (grid_.contains(id)) {
    if (!loader_(id, shape, around, *slot.page)) {
      free_.push_back(fresh);
      return nullptr;
    }
    ++loaded_;
    predictors_ += wanted ? 0 : 1;
  } else {
    wanted = true;
  }
  slot.id = id;
  slot.held = slot.used = true;
  slot.wanted = wanted;
  slot_of(id) = fresh;
  return slot.page;
}

template <class Word>
bool PageTree<Word>::surroundings(const PageId& id, Surroundings<Word>& around) {
  if (grid_.is_complete(id)) return true;
  const LatticePoint extent = grid_.extent(id.level + 1);
  const AxisPlaces x(id.block.i, extent.i), y(id.block.j, extent.j), z(id.block.k, extent.k);
  for (int bz = 0; bz < z.block_count; ++bz) {
    for (int by = 0; by < y.block_count; ++by) {
      for (int bx = 0; bx < x.block_count; ++bx) {
        const auto block = [](const AxisPlaces& axis, int b) {
          return axis.blocks[static_cast<std::size_t>(b)];
        };
        const Page<Word>* from = page({id.level + 1, {block(x, bx), block(y, by), block(z, bz)}}, false);
        if (from == nullptr) return false;
        const Part part{x, y, z, {bx, by, bz}};
        if (parts_ == PageParts::kSamples) {
          copy_part<PageParts::kSamples>(part, *from, around);
        } else {
          copy_part<PageParts::kAll>(part, *from, around);
        }
      }
    }
  }
  return true;
}

template <class Word>
void PageTree<Word>::fill_coarser(const PageShape& shape, const Surroundings<Word>& around,
                                  Page<Word>& page) const {
  for (std::int32_t k = 0; k < shape.count.k; k += 2) {
    for (std::int32_t j = 0; j < shape.count.j; j += 2) {
      const std::size_t to = PageGrid::place({0, j, k}, 0), from = surrounding_place({0, j, k});
      const auto fill = [=](const auto& coarser, auto& numbers) {
        using Lanes = EightLanes<typename std::remove_reference_t<decltype(numbers)>::value_type>;
        const Lanes lanes = Lanes::load(coarser.data() + from);
        Lanes::store_by_turns(lanes, lanes, numbers.data() + to);
      };
      fill(around.samples, page.samples);
      if (parts_ == PageParts::kSamples) continue;
      fill(around.low, page.low);
      fill(around.high, page.high);
      fill(around.errors, page.errors);
    }
  }
}

template <class Word>
std::uint32_t PageTree<Word>::free_slot() {
  if (!free_.empty()) {
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    return slot;
  }
  if (slots_.size() < capacity_) {
    slots_.push_back({{}, arena_.add()});
    return static_cast<std::uint32_t>(slots_.size() - 1);
  }
  for (;; considered_ = considered_ + 1 == slots_.size() ? 0 : considered_ + 1) {
    Slot& slot = slots_[considered_];
    if (!slot.held) continue;  // being loaded
    if (slot.used) {
      slot.used = false;
      continue;
    }
    slot.held = false;
    slot_of(slot.id) = kNone;
    return static_cast<std::uint32_t>(considered_);
  }
}

template class PageTree<std::uint8_t>;
template class PageTree<std::uint16_t>;
template class PageTree<std::uint32_t>;

}  // namespace adamas
