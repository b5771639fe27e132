#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>

#include "adamas/progress.h"
#include "isosurface/extraction/crossed_page.h"
#include "isosurface/extraction/page_mask.h"
#include "isosurface/extraction/page_walk.h"
#include "isosurface/extraction/split_limits.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_cut.h"

namespace adamas::isosurface {

/// A page that a cut has met, and what is known of it for one contour within the limits.
struct SplitPage : WalkedPage {
  std::unique_ptr<CrossedPage> crossed;  ///< null where it is not known
  std::unique_ptr<PageMask> mask;        ///< the memory for `split`
  std::size_t groups = 0;                ///< the number of the first groups of which diamonds are split
};

/// The diamonds that a cut by error classes splits, as masks of pages. Points of pages are in units of their
/// LOD here.
template <class Sample>
class SplitPages {
 public:
  using Reader = CrossedPageReader<Sample>;

  /// All arguments must outlive this.
  SplitPages(StoredDiamonds<Sample>& diamonds, const SurfaceRequest& surface, const SplitLimits& limits)
      : diamonds_(diamonds),
        limits_(limits),
        reader_(diamonds, surface, &limits),
        walk_(diamonds.grid(), diamonds.lods()) {}

  /// Finds the split diamonds, from the coarsest LOD on, and calls visit(page) for each page that has some.
  /// The caller may tighten the cut meanwhile, since it is read again for each page. Throws PageLost.
  template <class Visit>
  void find(const SurfaceCut& cut, Visit&& visit) {
    walk_.begin();
    greatest_left_ = 0;
    for (int lod = lods() - 1; lod >= 0; --lod) {
      for (SplitPage* const page : candidates(lod)) {
        greatest_left_ = std::max(greatest_left_, look_at(*page, cut, reader_));
        if (page->split == nullptr) continue;
        walk_.active(lod).push_back(page);
        visit(*page);
      }
    }
  }
  /// Finds the split diamonds of a cut in several threads. Each thread reads by one of `readers`, all of
  /// which have the same contour, limits and store, but pages of their own. Throws PageLost.
  void find(const SurfaceCut& cut, std::span<Reader* const> readers, Progress& progress);
  /// Forgets what was found; must be called when the contour or the limits have changed. `several_cuts`:
  /// whether find() will be called more than once, for which the crossed diamonds of pages are kept.
  void forget(bool several_cuts) {
    walk_.clear();
    several_cuts_ = several_cuts;
  }
  /// Finds how many triangles the splits of those groups of a page add that the cut splits. Throws PageLost.
  void count(SplitPage& page) { reader_.count(page.lod, page.block, page.groups, *page.crossed); }

  /// Reads by the diamonds of this object.
  [[nodiscard]] Reader& reader() { return reader_; }
  [[nodiscard]] int lods() const { return walk_.lods(); }
  /// See LatticeSamples.
  [[nodiscard]] int generation(int lod) const { return diamonds_.generation(lod); }
  /// The split diamonds of a page; null where nothing is split.
  [[nodiscard]] const PageMask* split_of(int lod, LatticePoint block) const {
    return walk_.split_of(lod, block);
  }
  /// How many diamonds are split.
  [[nodiscard]] std::size_t count() const;
  /// Calls visit(page) for each page that has split diamonds, from the coarsest LOD on, in z-order.
  template <class Visit>
  void for_each_page(Visit&& visit) const {
    for (int lod = lods() - 1; lod >= 0; --lod) {
      for (const SplitPage* const page : walk_.active(lod)) visit(*page);
    }
  }
  /// The lattice point of a page's point.
  [[nodiscard]] LatticePoint in_lattice(const WalkedPage& page, LatticePoint q) const {
    return diamonds_.lattice_step(page.lod) * (PageGrid::kSide * page.block + q);
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
  [[nodiscard]] const std::vector<SplitPage*>& candidates(int lod) {
    return walk_.candidates(
        lod, [this](const SplitPage& page) { return reader_.allows_any(page.lod, page.block); });
  }
  /// Finds what a cut splits on a page. Returns the greatest class of its diamonds that are crossed and not
  /// split, or an upper bound where the directory tells that nothing is split. Throws PageLost.
  int look_at(SplitPage& page, const SurfaceCut& cut, Reader& reader) const;

  StoredDiamonds<Sample>& diamonds_;
  const SplitLimits& limits_;
  Reader reader_;
  PageWalk<SplitPage> walk_;
  bool several_cuts_ = false;
  int greatest_left_ = 0;
};

}  // namespace adamas::isosurface
