#include "isosurface/extraction/split_pages.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "core/base/parallel.h"
#include "isosurface/extraction/child_pages.h"

namespace adamas::isosurface {

namespace {

constexpr std::int32_t kSide = PageGrid::kSide;

/// Whether all codes of a row are 0: no diamond of it is crossed with an error.
bool is_zero(const std::uint8_t* codes) {
  std::array<std::uint64_t, 2> row;
  std::memcpy(row.data(), codes, sizeof row);
  return (row[0] | row[1]) == 0;
}

}  // namespace

template <class Sample>
std::size_t SplitPages<Sample>::count() const {
  std::size_t sum = 0;
  for (const Lod& lod : lods_) {
    for (const PageOfLod& page : lod.pages) sum += page.split == nullptr ? 0 : page.split->count();
  }
  return sum;
}

template <class Sample>
int SplitPages<Sample>::class_if_allowed(LatticePoint p) {
  if (!diamonds_.is_stored(p)) return 0;
  if (limits_.any() && !limits_.allow(diamonds_.in_samples(p), diamonds_.lod(p), Diamond(p).phase()))
    return 0;
  return diamonds_.class_if_crossed(p);
}

template <class Sample>
bool SplitPages<Sample>::is_lost(LatticePoint p) const {
  const int lod = diamonds_.lod(p);
  return !limits_.lost.empty() && lod >= 0 &&
         limits_.lost.blocks(diamonds_.in_samples(p), lod, Diamond(p).phase());
}

template <class Sample>
std::vector<LatticePoint> SplitPages<Sample>::candidates(int lod) {
  const PageGrid& grid = diamonds_.grid();
  if (lod >= grid.top()) return {{0, 0, 0}};
  LatticeMap<std::uint8_t> met;
  std::vector<std::pair<std::uint64_t, LatticePoint>> found;
  const auto add = [&](LatticePoint block) {
    if (!has_page(grid, lod, block) || !met.insert(block).second) return;
    found.emplace_back(ZOrder::interleave(block), block);
  };
  for (const PageOfLod& parent : pages(lod + 1)) {
    if (parent.split == nullptr) continue;
    const ChildPages children =
        limits_.any() ? allowed_children(lod + 1, parent) : child_pages(*parent.split);
    for_each_child_page(parent.block, children, add);
  }
  for (std::size_t n = 0; n < found.size(); ++n) {
    for_each_page_of_last_points(grid, lod, found[n].second, [&](LatticePoint next) {
      if (may_split(lod, next)) add(next);
    });
  }
  std::sort(found.begin(), found.end());
  std::vector<LatticePoint> in_order;
  in_order.reserve(found.size());
  for (const auto& [order, block] : found) in_order.push_back(block);
  return in_order;
}

template <class Sample>
ChildPages SplitPages<Sample>::allowed_children(int lod, const PageOfLod& parent) const {
  ChildPages found = 0;
  parent.split->for_each([&](LatticePoint q) {
    const DiamondStencil& stencil = DiamondStencil::at(q);
    if (stencil.phase != 2) return;
    for (const LatticePoint offset : stencil.children) {
      const LatticePoint child = 2 * q + offset;
      if (!limits_.allow((1 << (lod - 1)) * (2 * kSide * parent.block + child), lod - 1, 0)) continue;
      found |= 1u << page_around(child);
    }
  });
  return found;
}

template <class Sample>
bool SplitPages<Sample>::may_split(int lod, LatticePoint block) const {
  if (!limits_.any()) return true;
  PageMask all;
  all.rows.fill(kOddPoints | kEvenPoints);
  limit(lod, block, all);
  return all.any();
}

template <class Sample>
const typename StoredDiamonds<Sample>::Codes& SplitPages<Sample>::codes(int lod, LatticePoint block) {
  const PageId asked{lod, block};
  if (codes_of_ != asked) {
    codes_of_ = {-1, {}};
    if (lod == 0) {
      find_finest_codes(asked);
    } else {
      diamonds_.find_crossed(lod, block, codes_);
    }
    codes_of_ = asked;
  }
  return codes_;
}

template <class Sample>
void SplitPages<Sample>::find_finest_codes(const PageId& page) {
  const auto place_of = [](LatticePoint q) { return PageGrid::place(q, 0); };
  if (const std::uint32_t* index = finest_.indices.find(page.block)) {
    const CrossedCodes& known = finest_.pages[*index];
    codes_.fill(0);
    const std::uint8_t* next = known.codes.data();
    known.crossed.for_each([&](LatticePoint q) { codes_[place_of(q)] = *next++; });
    return;
  }
  diamonds_.find_crossed(page.lod, page.block, codes_);
  diamonds_.pages().drop_bounds(page);
  if (!several_cuts_) return;
  *finest_.indices.insert(page.block).first = static_cast<std::uint32_t>(finest_.pages.size());
  CrossedCodes& found = finest_.pages.emplace_back();
  for (std::size_t row = 0; row < found.crossed.rows.size(); ++row)
    found.crossed.rows[row] = static_cast<std::uint16_t>(row_not_less(codes_.data() + kSide * row, 1));
  found.codes.reserve(found.crossed.count());
  found.crossed.for_each([&](LatticePoint q) { found.codes.push_back(codes_[place_of(q)]); });
}

template <class Sample>
std::vector<LatticePoint> SplitPages<Sample>::blocks_of(const Lod& lod) {
  std::vector<LatticePoint> blocks;
  blocks.reserve(lod.pages.size());
  for (const PageOfLod& page : lod.pages) blocks.push_back(page.block);
  return blocks;
}

template <class Sample>
void SplitPages<Sample>::find(const SurfaceCut& cut, std::span<SplitPages* const> of_threads,
                              Progress& progress) {
  greatest_left_ = 0;
  for (int lod = lods() - 1; lod >= 0; --lod) {
    progress.step("reading", 1 - (lod + 1.0) / lods());
    lods_[static_cast<std::size_t>(lod)] = {};
    const std::vector<LatticePoint> blocks = candidates(lod);
    std::vector<PageOfLod> pages(blocks.size());
    std::vector<PageMask> split(blocks.size());
    // Each thread has about the same part of the volume at all LODs, as finer pages are predicted from
    // coarser ones.
    constexpr std::size_t kLeastPages = 16;
    const std::size_t threads = std::clamp<std::size_t>(blocks.size() / kLeastPages, 1, of_threads.size());
    for (std::size_t t = 1; t < threads; ++t) of_threads[t]->greatest_left_ = greatest_left_;
    parallel_for(threads, 1, [&](std::size_t t) {
      SplitPages& finder = *of_threads[t];
      for (std::size_t n = blocks.size() * t / threads; n < blocks.size() * (t + 1) / threads; ++n) {
        pages[n] = unknown_page(lod, blocks[n], cut);
        split[n] = finder.split_of(lod, finder.look_at_left(lod, cut), pages[n]);
        finder.greatest_left_ = std::max(finder.greatest_left_, pages[n].greatest_left);
      }
    });
    for (std::size_t n = 0; n < blocks.size(); ++n) add(lod, pages[n], split[n]);
  }
}

template <class Sample>
void SplitPages<Sample>::add(int lod, PageOfLod page, const PageMask& split) {
  if (split.any()) {
    PageMask* const kept = masks_.add();
    *kept = split;
    page.split = kept;
  }
  greatest_left_ = std::max(greatest_left_, page.greatest_left);
  Lod& of = lods_[static_cast<std::size_t>(lod)];
  *of.indices.insert(page.block).first = static_cast<std::uint32_t>(of.pages.size());
  of.pages.push_back(page);
}

template <class Sample>
bool SplitPages<Sample>::look_into(int lod, LatticePoint block, const SurfaceCut& cut, const Lod& before) {
  PageOfLod page = unknown_page(lod, block, cut);
  const std::uint32_t* index = before.indices.find(block);
  const PageOfLod* last = index == nullptr ? nullptr : &before.pages[*index];
  const bool is_as_before = last != nullptr && last->cut == page.cut &&
                            (last->greatest_left != kUnknown || !look_at_left(lod, cut));
  if (is_as_before) {
    add(lod, *last, {});
  } else {
    const PageMask split = split_of(lod, look_at_left(lod, cut), page);
    add(lod, page, split);
  }
  return is_as_before;
}

template <class Sample>
PageMask SplitPages<Sample>::split_of(int lod, bool look_at_left, PageOfLod& page) {
  if (lod < diamonds_.grid().top()) {
    const int greatest = diamonds_.greatest_class({lod, page.block});
    if (greatest < static_cast<int>(page.cut.least()) + 4 * lod) {
      page.greatest_left = greatest;
      return {};
    }
  }
  const auto& all = codes(lod, page.block);
  PageMask mask, left;
  for (std::size_t row = 0; row < mask.rows.size(); ++row) {
    const std::uint8_t* const of_row = all.data() + kSide * row;
    if (is_zero(of_row)) continue;
    const RowPhases phases(static_cast<std::int32_t>(row % kSide), static_cast<std::int32_t>(row / kSide));
    const unsigned split = page.cut.split(of_row, phases, row);
    mask.rows[row] = static_cast<std::uint16_t>(split);
    if (look_at_left) left.rows[row] = static_cast<std::uint16_t>(row_not_less(of_row, 1) & ~split);
  }
  if (limits_.any()) {
    limit(lod, page.block, mask);
    limit(lod, page.block, left);
  }
  if (look_at_left) {
    page.greatest_left = 0;
    left.for_each([&](LatticePoint q) {
      page.greatest_left = std::max(page.greatest_left, error_class(all[PageGrid::place(q, 0)], lod));
    });
  }
  return mask;
}

template <class Sample>
void SplitPages<Sample>::limit(int lod, LatticePoint block, PageMask& mask) const {
  const PageMask before = mask;
  before.for_each([&](LatticePoint q) {
    const LatticePoint p = (1 << lod) * (kSide * block + q);
    const int phase = 3 - (q.i & 1) - (q.j & 1) - (q.k & 1);
    if (!limits_.allow(p, lod, phase))
      mask.rows[static_cast<std::size_t>(q.j + kSide * q.k)] &= static_cast<std::uint16_t>(~(1u << q.i));
  });
}

template class SplitPages<std::uint8_t>;
template class SplitPages<std::uint16_t>;
template class SplitPages<std::int16_t>;
template class SplitPages<float>;

}  // namespace adamas::isosurface
