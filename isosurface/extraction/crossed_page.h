#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isosurface/extraction/child_pages.h"
#include "isosurface/extraction/split_limits.h"
#include "isosurface/extraction/triangle_counter.h"

namespace adamas::isosurface {

/// The diamonds of a page of an LOD that a contour crosses and that have an error. They are the same in every
/// view. The coarsest page of a store counts as one page for each of its LODs.
struct CrossedPage {
  /// The diamonds of one error code and phase.
  struct Group {
    std::uint8_t code = 0, phase = 0;
    std::uint16_t begin = 0, end = 0;   ///< the diamonds' range in `places`
    ChildPages children = 0;            ///< the pages with their children, where the phase is 2
    std::uint32_t added = 0, lost = 0;  ///< the sums of the diamonds' changes
  };

  /// The groups in the order of SurfaceCut: those of greater codes come first, then those of lesser phases.
  std::vector<Group> groups;
  std::vector<std::uint16_t> places;  ///< PageGrid::place(q, 0) of each diamond, ascending in each group
  std::size_t counted = 0;            ///< the number of groups for which `added` and `lost` are known
  /// How many triangles a split adds, by index in `places`. Where the border of the data cuts triangles, a
  /// split may remove some: then `added` is 0, and `lost` is how many. `lost` is empty where no split does.
  std::vector<std::uint8_t> added, lost;
  /// The pages round this one, as bits by step_around, that have members of each group's diamonds. The vector
  /// has as many groups as find_members() was asked for.
  std::vector<std::uint32_t> members;

  /// How many triangles a split adds and removes, by index in `places`, where that is known.
  struct Change {
    std::uint32_t added = 0, lost = 0;
  };
  [[nodiscard]] Change change(std::size_t n) const { return {added[n], lost.empty() ? 0u : lost[n]}; }

  void forget_counts();
  /// The places in the groups before `groups` whose changes are not known.
  [[nodiscard]] std::span<const std::uint16_t> uncounted(std::size_t groups) const;
  /// Sets the changes for these places; negative changes remove triangles.
  void set_counted(std::size_t groups, std::span<const std::int16_t> changes);
  /// Sets `members` for the first groups, so many as are wanted.
  void find_members(std::size_t groups);
  [[nodiscard]] std::size_t bytes() const {
    return sizeof(*this) + groups.capacity() * sizeof(Group) + places.capacity() * sizeof(std::uint16_t) +
           added.capacity() + lost.capacity() + members.capacity() * sizeof(std::uint32_t);
  }
  static LatticePoint point(std::uint16_t place) {
    constexpr std::int32_t kSide = PageGrid::kSide;
    return {place % kSide, place / kSide % kSide, place / (kSide * kSide)};
  }
};

/// Finds what a contour crosses on pages.
template <class Sample>
class CrossedPageReader {
 public:
  /// `limits`: which diamonds count; null where all do. All arguments must outlive this.
  CrossedPageReader(StoredDiamonds<Sample>& diamonds, const SurfaceRequest& surface,
                    const SplitLimits* limits = nullptr)
      : diamonds_(diamonds), limits_(limits), counter_(diamonds, surface) {}

  [[nodiscard]] StoredDiamonds<Sample>& diamonds() const { return diamonds_; }
  /// Finds the crossed diamonds of a page whose codes are not below `least`, and, of the others, those of the
  /// greatest code. Throws PageLost.
  CrossedPage read(int lod, LatticePoint block, unsigned least = 1);
  /// Finds the crossed diamonds by the bounds of a page that is not the coarsest one, and that the contour
  /// crosses. Where pages are not loaded, several readers may do this and count() at the same time.
  CrossedPage read(int lod, LatticePoint block,
                   const PageBounds<typename StoredDiamonds<Sample>::Word>& bounds);
  /// Frees the memory of a read page's bounds, where they will hardly be needed again.
  void drop_bounds(int lod, LatticePoint block);
  /// Finds how many triangles the splits at some places of a page add. Throws PageLost. Several readers may
  /// do this at the same time where pages are not loaded.
  void find_changes(int lod, LatticePoint block, std::span<const std::uint16_t> places,
                    std::span<std::int16_t> changes);
  /// Finds how many triangles the splits of the groups before `groups` add. Throws PageLost.
  void count(int lod, LatticePoint block, std::size_t groups, CrossedPage& page);
  /// The pages that have children, within the limits, of a page's diamond of phase 2.
  [[nodiscard]] ChildPages children(int lod, LatticePoint block, LatticePoint q) const;
  /// Whether the limits let any diamond of a page count.
  [[nodiscard]] bool allows_any(int lod, LatticePoint block) const;

 private:
  /// Makes the page of the crossed diamonds of codes_ whose codes are not below `least`.
  [[nodiscard]] CrossedPage page_of_codes(int lod, LatticePoint block, unsigned least) const;
  [[nodiscard]] bool is_limited() const { return limits_ != nullptr && limits_->any(); }
  /// Whether the limits let a diamond of a page count.
  [[nodiscard]] bool allows(int lod, LatticePoint block, LatticePoint q) const;
  /// Sets those of codes_ to 0 whose diamonds the limits leave out.
  void limit_codes(int lod, LatticePoint block);

  StoredDiamonds<Sample>& diamonds_;
  const SplitLimits* limits_;
  PageTriangleCounter<Sample> counter_;
  typename StoredDiamonds<Sample>::Codes codes_;
};

}  // namespace adamas::isosurface
