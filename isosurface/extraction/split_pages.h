#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "core/base/stable_vector.h"
#include "core/lattice/lattice_map.h"
#include "isosurface/extraction/child_pages.h"
#include "isosurface/extraction/diamond_stencil.h"
#include "isosurface/extraction/page_mask.h"
#include "isosurface/extraction/split_limits.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_cut.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

/// The diamonds that a cut splits, as masks of pages. Points of pages are in units of their LOD here, and the
/// coarsest page of a store counts as one page for each of its LODs.
template <class Sample>
class SplitPages {
 public:
  using Word = typename StoredDiamonds<Sample>::Word;

  struct PageOfLod {
    LatticePoint block;
    const PageMask* split = nullptr;  ///< null where nothing is split
    CutOfPage cut;                    ///< the cut that the mask is of
    /// The greatest class that is crossed and not split, or an upper bound where the page's diamonds were not
    /// looked at.
    int greatest_left = kUnknown;
  };

  /// Both arguments must outlive this.
  SplitPages(StoredDiamonds<Sample>& diamonds, const SplitLimits& limits)
      : diamonds_(diamonds), limits_(limits), lods_(static_cast<std::size_t>(diamonds.lods())) {}

  /// Finds the split diamonds, from the coarsest LOD on, and calls visit(lod, page) for each page that has
  /// some. The caller may tighten the cut meanwhile, since it is read again for each page. A page is not
  /// looked into again where the cut is the same on it as in the call before. Throws PageLost.
  template <class Visit>
  void find(const SurfaceCut& cut, Visit&& visit) {
    greatest_left_ = 0;
    bool is_as_before = false;
    for (int lod = diamonds_.lods() - 1; lod >= 0; --lod) {
      Lod& of = lods_[static_cast<std::size_t>(lod)];
      const Lod before = std::exchange(of, {});
      const std::vector<LatticePoint> blocks = is_as_before ? blocks_of(before) : candidates(lod);
      is_as_before = blocks.size() == before.pages.size();
      for (const LatticePoint block : blocks) {
        is_as_before = look_into(lod, block, cut, before) && is_as_before;
        if (of.pages.back().split != nullptr) visit(lod, of.pages.back());
      }
    }
  }
  /// Finds the split diamonds of a single cut in several threads. Each thread works with one of `of_threads`,
  /// the first of which is this object; all have the same contour, limits and store, but pages of their own.
  void find(const SurfaceCut& cut, std::span<SplitPages* const> of_threads, Progress& progress);
  /// Forgets what was found; must be called when the contour or the limits have changed. `several_cuts`:
  /// whether find() will be called more than once.
  void forget(bool several_cuts) {
    lods_.assign(lods_.size(), {});
    masks_ = {};
    codes_of_ = {-1, {}};
    several_cuts_ = several_cuts;
    finest_ = {};
  }

  /// The error codes of a page's crossed diamonds, and 0 of others; that of q is at PageGrid::place(q, 0).
  /// The reference is valid until the next call of any member. Throws PageLost.
  const typename StoredDiamonds<Sample>::Codes& codes(int lod, LatticePoint block);

  [[nodiscard]] int lods() const { return diamonds_.lods(); }
  /// See LatticeSamples.
  [[nodiscard]] int generation(int lod) const { return diamonds_.generation(lod); }
  /// The pages of an LOD that were looked into, in z-order.
  [[nodiscard]] const std::vector<PageOfLod>& pages(int lod) const {
    return lods_[static_cast<std::size_t>(lod)].pages;
  }
  /// The page of an LOD at a block; null where it was not looked into.
  [[nodiscard]] const PageOfLod* page(int lod, LatticePoint block) const {
    if (lod < 0) return nullptr;
    const Lod& of = lods_[static_cast<std::size_t>(lod)];
    const std::uint32_t* index = of.indices.find(block);
    return index == nullptr ? nullptr : &of.pages[*index];
  }
  /// The split diamonds of a page; null where nothing is split.
  [[nodiscard]] const PageMask* split_of(int lod, LatticePoint block) const {
    const PageOfLod* const found = page(lod, block);
    return found == nullptr ? nullptr : found->split;
  }
  /// How many diamonds are split.
  [[nodiscard]] std::size_t count() const;
  /// Calls visit(lod, page) for each page that has split diamonds, from the coarsest LOD on, in z-order.
  template <class Visit>
  void for_each_page(Visit&& visit) const {
    for (int lod = lods() - 1; lod >= 0; --lod) {
      for (const PageOfLod& page : pages(lod)) {
        if (page.split != nullptr) visit(lod, page);
      }
    }
  }
  /// The lattice point of a page's point.
  [[nodiscard]] LatticePoint in_lattice(int lod, LatticePoint block, LatticePoint q) const {
    return diamonds_.lattice_step(lod) * (PageGrid::kSide * block + q);
  }

  /// The error class of the diamond of any lattice point where it is crossed and the limits allow to split
  /// it, else 0. Throws PageLost.
  int class_if_allowed(LatticePoint p);
  /// Whether the diamond may not be split because of lost pages.
  [[nodiscard]] bool is_lost(LatticePoint p) const;

  /// The greatest class of the diamonds that are crossed and not split. For a page on which nothing is split
  /// the greatest class in the directory counts too. Some diamond of the mesh has this class, since the
  /// classes of children are not greater than those of their parents.
  [[nodiscard]] int greatest_left() const { return greatest_left_; }

 private:
  static constexpr int kUnknown = -1;

  struct Lod {
    std::vector<PageOfLod> pages;
    LatticeMap<std::uint32_t> indices;  ///< into pages, by block
  };

  /// The crossed diamonds of a page and their error codes.
  struct CrossedCodes {
    PageMask crossed;
    std::vector<std::uint8_t> codes;  ///< one for each diamond of `crossed`, i running fastest
  };
  /// The error codes of pages of the finest LOD. They are kept apart, as the bounds of these pages predict no
  /// others and leave the memory at once.
  struct FinestCodes {
    std::vector<CrossedCodes> pages;
    LatticeMap<std::uint32_t> indices;  ///< into pages, by block
  };

  /// The pages of an LOD, in z-order, on which diamonds may be split, since parents of theirs are split.
  std::vector<LatticePoint> candidates(int lod);
  /// The pages of the next finer LOD that have children of a page's split diamonds which the limits allow.
  [[nodiscard]] ChildPages allowed_children(int lod, const PageOfLod& parent) const;
  /// Whether the limits allow to split any diamond of the page.
  [[nodiscard]] bool may_split(int lod, LatticePoint block) const;
  static std::vector<LatticePoint> blocks_of(const Lod& lod);
  void find_finest_codes(const PageId& page);
  /// Makes the entry of a page whose split diamonds are not known yet.
  [[nodiscard]] PageOfLod unknown_page(int lod, LatticePoint block, const SurfaceCut& cut) const {
    return {.block = block, .cut = {cut, lod, generation(lod), ZOrder::interleave(block)}};
  }
  /// Adds a page to its LOD, with its split diamonds unless the page has a mask already.
  void add(int lod, PageOfLod page, const PageMask& split);
  /// Finds what is split on a page, and adds the page to its LOD. Returns whether the same was split before.
  bool look_into(int lod, LatticePoint block, const SurfaceCut& cut, const Lod& before);
  /// Whether diamonds of an LOD that are left have to be looked at for the greatest class.
  [[nodiscard]] bool look_at_left(int lod, const SurfaceCut& cut) const {
    return greatest_left_ < cut.greatest_left(generation(lod));
  }
  /// Returns the diamonds of a page that its cut splits. Sets the greatest class that is left where
  /// `look_at_left` asks for it or the directory tells it.
  PageMask split_of(int lod, bool look_at_left, PageOfLod& page);
  /// Takes the diamonds out of the mask that the limits keep from being split.
  void limit(int lod, LatticePoint block, PageMask& mask) const;

  StoredDiamonds<Sample>& diamonds_;
  const SplitLimits& limits_;
  std::vector<Lod> lods_;
  StableVector<PageMask> masks_;
  typename StoredDiamonds<Sample>::Codes codes_;  ///< the error codes that codes() gave last
  PageId codes_of_{-1, {}};                       ///< the LOD and the block that codes_ belong to
  bool several_cuts_ = false;
  FinestCodes finest_;  ///< where there are several cuts
  int greatest_left_ = 0;
};

extern template class SplitPages<std::uint8_t>;
extern template class SplitPages<std::uint16_t>;
extern template class SplitPages<std::int16_t>;
extern template class SplitPages<float>;

}  // namespace adamas::isosurface
