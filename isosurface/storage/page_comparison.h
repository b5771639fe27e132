#pragma once

#include "isosurface/storage/stored_pages.h"

namespace adamas::isosurface {

/// Finds out whether pages are the same at two steps of a series. Pages that are in memory at both steps are
/// compared. For others, the directory may say that they are the same; those of coarser LODs are loaded, if
/// the pages load at all, and those of the finest LOD are not. So some pages that are the same are not
/// recognised.
template <class Word>
class PageComparison {
 public:
  /// Makes the object. The pages must outlive it.
  PageComparison(StoredPages<Word>& before, StoredPages<Word>& after) : before_(before), after_(after) {}

  /// Returns whether all samples of a page are known to be the same. The grid need not contain the page, if
  /// it has a cube for it.
  bool has_same_samples(const PageId& page);
  /// Returns whether the bounds of a page's own points are known to be the same.
  bool has_same_bounds(const PageId& page);

 private:
  /// Returns whether the samples of a page from `first` to `last`, both included, are known to be the same.
  bool has_same_points(const PageId& page, LatticePoint first, LatticePoint last);
  /// Returns whether the directory says that a page's own points have the same samples and bounds.
  bool is_same_by_directory(const PageId& page);
  [[nodiscard]] bool is_uniform(const PageId& id, const PageEntry& entry) const;
  [[nodiscard]] bool loads() const { return before_.loads() && after_.loads(); }

  StoredPages<Word>&before_, &after_;
};

}  // namespace adamas::isosurface
