#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "core/lattice/lattice_map.h"
#include "isosurface/extraction/child_pages.h"
#include "isosurface/extraction/page_mask.h"
#include "isosurface/volume/page_grid.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

/// What a walk over pages knows of each page that it meets. The coarsest page of a store counts as one page
/// for each of its LODs.
struct WalkedPage {
  int lod = 0;
  LatticePoint block{};
  std::uint64_t order = 0;  ///< the place of the page's cube in z-order
  std::uint64_t met = 0;    ///< the walk that met the page last
  /// The pages with children of those of its diamonds that the last walk was about.
  ChildPages children = 0;
  const PageMask* split = nullptr;  ///< the split diamonds; null where nothing is split
};

/// Walks over the pages on which diamonds may be split, from the coarsest LOD on: parents of such diamonds
/// may be split too, so that the pages of an LOD are found by the children of diamonds on the next coarser
/// one. Pages that were met stay, with all that is known of them, for later walks. Page: derived from
/// WalkedPage.
template <class Page>
class PageWalk {
 public:
  /// `lods`: the number of LODs that have diamonds. The grid must outlive this.
  PageWalk(const PageGrid& grid, int lods)
      : grid_(grid), index_(static_cast<std::size_t>(lods)), active_(index_.size()) {}

  [[nodiscard]] int lods() const { return static_cast<int>(index_.size()); }
  /// Forgets all pages.
  void clear() {
    for (auto& of_lod : active_) of_lod.clear();
    for (auto& of_lod : index_) of_lod.clear();
    pages_.clear();
  }
  /// Begins a walk; then candidates() is to be called for each LOD, from the coarsest one on.
  void begin() { ++number_; }
  /// A number for the present walk, greater than that of all before.
  [[nodiscard]] std::uint64_t number() const { return number_; }
  /// Finds the pages of an LOD, in z-order, that may have children of diamonds of the active pages of the
  /// next coarser LOD. Calls meet(page) for each, which says whether the walk is to go on with the page. No
  /// page of the LOD is active then. The result is valid until the next call.
  template <class Meet>
  const std::vector<Page*>& candidates(int lod, Meet&& meet);
  /// The pages of an LOD, in z-order, that the walk has found to have diamonds which it is about; the walk
  /// adds them.
  [[nodiscard]] std::vector<Page*>& active(int lod) { return active_[static_cast<std::size_t>(lod)]; }
  [[nodiscard]] const std::vector<Page*>& active(int lod) const {
    return active_[static_cast<std::size_t>(lod)];
  }

  /// The page of an LOD at a block; null where no walk has met it.
  [[nodiscard]] Page* find(int lod, LatticePoint block) const {
    if (lod < 0 || lod >= lods()) return nullptr;
    Page* const* const found = index_[static_cast<std::size_t>(lod)].find(block);
    return found == nullptr ? nullptr : *found;
  }
  /// The split diamonds of a page in the present walk; null where nothing is split.
  [[nodiscard]] const PageMask* split_of(int lod, LatticePoint block) const {
    const Page* const page = find(lod, block);
    return page == nullptr || page->met != number_ ? nullptr : page->split;
  }
  /// All pages that were met, in no order.
  [[nodiscard]] std::deque<Page>& pages() { return pages_; }

 private:
  Page& page(int lod, LatticePoint block);

  const PageGrid& grid_;
  std::deque<Page> pages_;
  std::vector<LatticeMap<Page*>> index_;  ///< by LOD and block
  std::vector<std::vector<Page*>> active_;
  std::vector<Page*> candidates_;
  std::uint64_t number_ = 0;
};

template <class Page>
Page& PageWalk<Page>::page(int lod, LatticePoint block) {
  const auto [found, is_new] = index_[static_cast<std::size_t>(lod)].insert(block);
  if (!is_new) return **found;
  Page& added = pages_.emplace_back();
  added.lod = lod;
  added.block = block;
  added.order = ZOrder::interleave(block);
  *found = &added;
  return added;
}

template <class Page>
template <class Meet>
const std::vector<Page*>& PageWalk<Page>::candidates(int lod, Meet&& meet) {
  candidates_.clear();
  active(lod).clear();
  const auto add = [&](LatticePoint block) {
    if (!has_page(grid_, lod, block)) return;
    Page& met = page(lod, block);
    if (std::exchange(met.met, number_) == number_) return;
    met.split = nullptr;
    met.children = 0;
    if (meet(met)) candidates_.push_back(&met);
  };
  if (lod >= grid_.top()) {
    add({0, 0, 0});
    return candidates_;
  }
  for (const Page* parent : active(lod + 1)) for_each_child_page(parent->block, parent->children, add);
  for (std::size_t n = 0; n < candidates_.size(); ++n)
    for_each_page_of_last_points(grid_, lod, candidates_[n]->block, add);
  std::ranges::sort(candidates_, {}, &Page::order);
  return candidates_;
}

}  // namespace adamas::isosurface
