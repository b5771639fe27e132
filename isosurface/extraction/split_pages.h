#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "adamas/progress.h"
#include "core/base/stable_vector.h"
#include "core/lattice/lattice_map.h"
#include "isosurface/extraction/diamond_stencil.h"
#include "isosurface/extraction/split_limits.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_cut.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

/// A set of a page's diamonds: bit i of row j + 16 k.
struct PageMask {
  std::array<std::uint16_t, std::size_t{PageGrid::kSide} * PageGrid::kSide> rows{};

  bool operator==(const PageMask&) const = default;

  [[nodiscard]] bool has(LatticePoint q) const {
    return (rows[static_cast<std::size_t>(q.j + PageGrid::kSide * q.k)] >> q.i & 1) != 0;
  }
  /// Adds the diamond at a place, PageGrid::place(q, 0).
  void add(std::uint16_t place) {
    std::uint16_t& row = rows[place / PageGrid::kSide];
    row = static_cast<std::uint16_t>(row | 1u << place % PageGrid::kSide);
  }
  void remove(std::uint16_t place) {
    std::uint16_t& row = rows[place / PageGrid::kSide];
    row = static_cast<std::uint16_t>(row & ~(1u << place % PageGrid::kSide));
  }
  [[nodiscard]] bool any() const {
    return std::any_of(rows.begin(), rows.end(), [](std::uint16_t row) { return row != 0; });
  }
  [[nodiscard]] std::size_t count() const {
    // Bits are counted in fields of two, four and eight bits, and summed up in fields of 16.
    std::uint64_t sum = 0;
    for (std::size_t row = 0; row < rows.size(); row += 4) {
      std::uint64_t four;
      std::memcpy(&four, rows.data() + row, sizeof four);
      four -= four >> 1 & 0x5555555555555555u;
      four = (four & 0x3333333333333333u) + (four >> 2 & 0x3333333333333333u);
      four = (four + (four >> 4)) & 0x0f0f0f0f0f0f0f0fu;
      sum += (four & 0x00ff00ff00ff00ffu) + (four >> 8 & 0x00ff00ff00ff00ffu);
    }
    return (sum & 0xffff) + (sum >> 16 & 0xffff) + (sum >> 32 & 0xffff) + (sum >> 48);
  }
  /// Calls visit(q) for each of them, i running fastest.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (unsigned bits = rows[row]; bits != 0; bits &= bits - 1) {
        visit(LatticePoint{std::countr_zero(bits), static_cast<std::int32_t>(row % PageGrid::kSide),
                           static_cast<std::int32_t>(row / PageGrid::kSide)});
      }
    }
  }
};

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

  /// Both must outlive this.
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
  /// The same for a single cut, without visits, on a thread for each of these, the first of which is this
  /// one. All have the same contour, the same limits and the same store, but pages of their own.
  void find(const SurfaceCut& cut, std::span<SplitPages* const> of_threads, Progress& progress);
  /// Forgets what was found. To be called when the contour or the limits have changed. `several_cuts`:
  /// whether find() will be called more than once.
  void forget(bool several_cuts) {
    lods_.assign(lods_.size(), {});
    masks_ = {};
    codes_of_ = {-1, {}};
    several_cuts_ = several_cuts;
    finest_ = {};
  }

  /// The error codes of a page's crossed diamonds, 0 of others: that of q at PageGrid::place(q, 0). Valid
  /// until the next call of anything. Throws PageLost.
  const typename StoredDiamonds<Sample>::Codes& codes(int lod, LatticePoint block);

  [[nodiscard]] int lods() const { return diamonds_.lods(); }
  /// The pages of an LOD that were looked into, in z-order.
  [[nodiscard]] const std::vector<PageOfLod>& pages(int lod) const {
    return lods_[static_cast<std::size_t>(lod)].pages;
  }
  /// Null where the page was not looked into.
  [[nodiscard]] const PageOfLod* page(int lod, LatticePoint block) const {
    if (lod < 0) return nullptr;
    const Lod& of = lods_[static_cast<std::size_t>(lod)];
    const std::uint32_t* index = of.indices.find(block);
    return index == nullptr ? nullptr : &of.pages[*index];
  }
  /// How many diamonds are split.
  [[nodiscard]] std::size_t count() const;
  /// Calls visit(lod, page, part) for each page that has split diamonds, from the coarsest LOD on, in
  /// z-order; part: of the way to the end.
  template <class Visit>
  void for_each_page(Visit&& visit) const {
    for (int lod = lods() - 1; lod >= 0; --lod) {
      const auto& all = pages(lod);
      for (std::size_t n = 0; n < all.size(); ++n) {
        if (all[n].split == nullptr) continue;
        const double in_lod = static_cast<double>(n) / static_cast<double>(all.size());
        visit(lod, all[n], (lods() - 1 - lod + in_lod) / lods());
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
  [[nodiscard]] bool is_split(LatticePoint p) const;
  /// Whether the diamond of a lattice point reaches into the data.
  [[nodiscard]] bool is_in_data(LatticePoint p) const;
  /// Whether the diamond is kept from being split by pages that cannot be had.
  [[nodiscard]] bool is_lost(LatticePoint p) const;

  /// The greatest class of the diamonds that are crossed and not split. Of pages on which nothing is split
  /// the greatest class that the directory tells counts too. A diamond of the mesh has this class, since
  /// classes do not grow from parents to children.
  [[nodiscard]] int greatest_left() const { return greatest_left_; }

 private:
  static constexpr int kUnknown = -1;

  struct Lod {
    std::vector<PageOfLod> pages;
    LatticeMap<std::uint32_t> indices;  ///< into pages, by block
  };

  /// The codes of a page's crossed diamonds.
  struct CrossedCodes {
    PageMask crossed;
    std::vector<std::uint8_t> codes;  ///< of the crossed ones, i running fastest
  };
  /// The codes of pages of the finest LOD, whose bounds predict nothing and leave the memory at once.
  struct FinestCodes {
    std::vector<CrossedCodes> pages;
    LatticeMap<std::uint32_t> indices;  ///< into pages, by block
  };

  /// How many LODs an LOD is coarser than that of the page which has its points.
  [[nodiscard]] int lods_below(int lod) const {
    return lod > diamonds_.grid().top() ? lod - diamonds_.grid().top() : 0;
  }
  [[nodiscard]] PageId id(int lod, LatticePoint block) const { return {lod - lods_below(lod), block}; }

  /// The pages of an LOD on which diamonds may be split, since coarser ones are; in z-order.
  std::vector<LatticePoint> candidates(int lod);
  /// The pages of the next finer LOD that have children of a page's split diamonds which the limits allow:
  /// for three rows along j of three planes along k, from one page before the page's own on, three bits along
  /// i.
  [[nodiscard]] std::array<unsigned, 9> allowed_children(int lod, const PageOfLod& parent) const;
  /// Whether the limits allow to split any diamond of the page.
  [[nodiscard]] bool may_split(int lod, LatticePoint block) const;
  static std::vector<LatticePoint> blocks_of(const Lod& lod);
  void find_finest_codes(const PageId& page);
  /// Gathers the codes of an LOD that is coarser than the coarsest page's own, so that they lie side by side.
  void gather_codes(int lod);
  /// A page of which it is not known yet what is split.
  [[nodiscard]] PageOfLod unknown_page(int lod, LatticePoint block, const SurfaceCut& cut) const {
    return {.block = block, .cut = {cut, lod, generation(lod), ZOrder::interleave(block)}};
  }
  /// Adds a page to its LOD; with the diamonds that are split, where they are not kept already.
  void add(int lod, PageOfLod page, const PageMask& split);
  /// Adds a page to its LOD. Returns whether the same is split on it as before.
  bool look_into(int lod, LatticePoint block, const SurfaceCut& cut, const Lod& before);
  /// The generation of an LOD's diamonds of phase 0.
  [[nodiscard]] int generation(int lod) const { return 3 * (lods() - 1 - lod); }
  /// Whether diamonds of an LOD that are left have to be looked at for the greatest class.
  [[nodiscard]] bool look_at_left(int lod, const SurfaceCut& cut) const {
    // No diamond that is left has a greater class than this, and mostly one has just this class: then others
    // need not be looked at.
    return greatest_left_ < (cut.generation < generation(lod) + 3 ? cut.error_class : cut.error_class - 1);
  }
  /// The diamonds of a page that its cut splits. Sets the greatest class that is left where that is wanted or
  /// known without looking.
  PageMask split_of(int lod, bool look_at_left, PageOfLod& page);
  /// Takes the diamonds out of the mask that the limits keep from being split.
  void limit(int lod, LatticePoint block, PageMask& mask) const;

  StoredDiamonds<Sample>& diamonds_;
  const SplitLimits& limits_;
  std::vector<Lod> lods_;
  StableVector<PageMask> masks_;
  typename StoredDiamonds<Sample>::Codes codes_;  ///< of the page that was asked for last
  PageId codes_of_{-1, {}};                       ///< which page that is: the LOD asked for and the block
  bool several_cuts_ = false;
  FinestCodes finest_;  ///< where there are several cuts
  int greatest_left_ = 0;
};

extern template class SplitPages<std::uint8_t>;
extern template class SplitPages<std::uint16_t>;
extern template class SplitPages<std::int16_t>;
extern template class SplitPages<float>;

}  // namespace adamas::isosurface
