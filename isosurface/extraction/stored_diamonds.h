#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "isosurface/extraction/lattice_samples.h"
#include "isosurface/volume/error_scale.h"

namespace adamas::isosurface {

/// The diamonds of a store's lattice, with their stored bounds: their errors, and which of them a contour
/// crosses.
template <class Sample>
class StoredDiamonds : public LatticeSamples<Sample> {
 public:
  using Word = OrderedWord<Sample>;

  /// Makes the diamonds of these pages, which must outlive this.
  explicit StoredDiamonds(StoredPages<Word>& pages);

  /// Returns whether pages have bounds of the diamond of a lattice point: the point is no corner of the
  /// domain, and the diamond extends into the data.
  [[nodiscard]] bool is_stored(LatticePoint p) const {
    const int l = this->lod(p);
    if (l < 0 || l >= this->lods()) return false;
    // The coarsest page has points of its LOD whose diamonds lie wholly outside.
    const LatticePoint e = reaches_[static_cast<std::size_t>(l)], s = this->in_samples(p);
    return s.i <= e.i && s.j <= e.j && s.k <= e.k;
  }

  /// The number of error classes of all LODs together; see error_class().
  static constexpr int kErrorClasses = ErrorScale::kCodes + 4 * PageGrid::kMaxDepth;
  /// Returns the error of a class, in units of length.
  [[nodiscard]] double error(int error_class) const { return errors_[static_cast<std::size_t>(error_class)]; }
  /// Returns the greatest class whose error is not greater.
  [[nodiscard]] int class_within(double error) const;

  /// Changes to the pages of another step of the same store. The contour stays.
  void set_pages(StoredPages<Word>& pages) {
    LatticeSamples<Sample>::set_pages(pages);
    for (RecentEntry& recent : recent_) recent.id.lod = -1;
  }

  /// Sets the contour that all the following members refer to.
  void set_contour(double isovalue);
  /// Returns whether a sample is not below the isovalue.
  [[nodiscard]] bool is_above(Word word) const { return word >= least_above_; }
  /// Returns the error class of a stored diamond where the contour may cross it, and 0 where it does not.
  /// Throws PageLost.
  int class_if_crossed(LatticePoint p);
  /// The side of the contour on which all samples of a page lie, and all samples of its LOD's cells in its
  /// cube. It is kBoth where they lie on both sides or the directory does not tell. Throws PageLost.
  enum class Side : std::uint8_t { kBelow, kAbove, kBoth };
  Side side(const PageId& id);
  /// Returns the least word of a sample not below the isovalue; greater than all words where there is none.
  [[nodiscard]] std::uint64_t least_above() const { return least_above_; }
  /// Returns an upper bound of the classes of the page's diamonds that the contour crosses; 0 where it
  /// crosses none. It must not be called for the coarsest page, which has diamonds of several LODs. Throws
  /// PageLost.
  int greatest_class(const PageId& id);
  using Codes = PagePoints<std::uint8_t>;
  /// Finds the error codes of the diamonds that an LOD has on a page and the contour crosses, and 0 for all
  /// others, at the PageGrid::place of their points. The coarsest page counts as one page for each of its
  /// LODs. Throws PageLost.
  void find_crossed(int lod, LatticePoint block, Codes& codes);
  /// Finds them from the bounds of a page with diamonds that the contour crosses.
  void find_crossed(int lod, LatticePoint block, const PageBounds<Word>& bounds, Codes& codes) const;

 private:
  /// Moves the codes of an LOD's own diamonds side by side, and sets all others to 0.
  void keep_own(int lod, LatticePoint block, Codes& codes) const;
  const PageEntry& entry(const PageId& id);
  /// Returns whether the contour crosses a diamond whose samples lie between two words; false if low > high.
  [[nodiscard]] bool crosses(std::uint32_t low, std::uint32_t high) const {
    return low <= high && low < least_above_ && least_above_ <= high;
  }

  struct RecentEntry {
    PageId id{-1, {}};
    PageEntry entry;
  };

  /// The last point of each LOD, in samples, whose diamond extends into the data.
  std::array<LatticePoint, PageGrid::kMaxDepth + 2> reaches_{};
  std::vector<RecentEntry> recent_;  ///< the entry of each LOD that was used last
  std::uint64_t least_above_ = 0;    ///< the least ordered word of a value not below the isovalue
  std::array<double, kErrorClasses> errors_{};
};

}  // namespace adamas::isosurface
