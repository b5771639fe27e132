#pragma once

#include "isosurface/storage/stored_pages.h"

namespace adamas::isosurface {

/// Whether pages are the same at two steps of a series. What is in memory of both is compared. Of other pages
/// the directory may tell that they are; those of coarser LODs are loaded, where the pages load at all, and
/// those of the finest LOD are not. So pages that are the same may not be known to be.
template <class Word>
class PageComparison {
 public:
  /// The pages must outlive this.
  PageComparison(StoredPages<Word>& before, StoredPages<Word>& after) : before_(before), after_(after) {}

  /// All samples that a page has. The grid need not contain it, if it has a cube for it.
  bool has_same_samples(const PageId& page);
  /// The bounds of a page's own points.
  bool has_same_bounds(const PageId& page);

 private:
  /// The points of a page from one to another, both included.
  bool has_same_points(const PageId& page, LatticePoint first, LatticePoint last);
  /// Whether the directory tells that a page's own points have the same samples and bounds.
  bool says_directory(const PageId& page);
  [[nodiscard]] bool is_even(const PageId& id, const PageEntry& entry) const;
  [[nodiscard]] bool loads() const { return before_.loads() && after_.loads(); }

  StoredPages<Word>&before_, &after_;
};

extern template class PageComparison<std::uint8_t>;
extern template class PageComparison<std::uint16_t>;
extern template class PageComparison<std::uint32_t>;

}  // namespace adamas::isosurface
