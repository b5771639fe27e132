#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isosurface/extraction/child_pages.h"
#include "isosurface/extraction/triangle_counter.h"

namespace adamas::isosurface {

/// The diamonds of a page of an LOD that a contour crosses and that have an error. None of this depends on
/// where they are seen from. The coarsest page of a store counts as one page for each of its LODs.
struct CrossedPage {
  /// Those of one error code and phase.
  struct Group {
    std::uint8_t code = 0, phase = 0;
    std::uint16_t begin = 0, end = 0;   ///< in `places`
    ChildPages children = 0;            ///< those that have children of them, where they are of phase 2
    std::uint32_t added = 0, lost = 0;  ///< of all of them
  };

  std::vector<Group> groups;          ///< greater codes first, then lesser phases
  std::vector<std::uint16_t> places;  ///< PageGrid::place(q, 0), ascending in each group
  std::size_t counted = 0;            ///< of how many groups what follows is known
  /// How many triangles a split adds, by index in `places`. Where the border of the data cuts them it may be
  /// less than nothing: then `added` is 0, and `lost`, which is empty where there is no such split, tells by
  /// how many there are less.
  std::vector<std::uint8_t> added, lost;
  /// The pages of the LOD round this one that have members of the diamonds of each of the first groups, as
  /// bits: for each step from -1 to 1 along each axis, i running fastest. As far as find_members() was asked.
  std::vector<std::uint32_t> members;

  /// How many triangles a split adds and takes away, by index in `places`, where that is known.
  struct Change {
    std::uint32_t added = 0, lost = 0;
  };
  [[nodiscard]] Change change(std::size_t n) const { return {added[n], lost.empty() ? 0u : lost[n]}; }

  void forget_counts();
  /// The places in the groups before `groups` for which that is not known.
  [[nodiscard]] std::span<const std::uint16_t> uncounted(std::size_t groups) const;
  /// Sets it for these; negative changes take triangles away.
  void set_counted(std::size_t groups, std::span<const std::int16_t> changes);
  /// Finds these of so many groups.
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
  /// Both must outlive this.
  CrossedPageReader(StoredDiamonds<Sample>& diamonds, const SurfaceRequest& surface)
      : diamonds_(diamonds), counter_(diamonds, surface) {}

  /// Throws PageLost.
  CrossedPage read(int lod, LatticePoint block);
  /// The same of a page, but the coarsest, by its bounds; some of its diamonds the contour crosses. Where
  /// pages are not loaded, several readers may do this at the same time, and count.
  CrossedPage read(int lod, LatticePoint block,
                   const PageBounds<typename StoredDiamonds<Sample>::Word>& bounds);
  /// Frees the memory of bounds that will hardly be needed again, of a page that was read.
  void drop_bounds(int lod, LatticePoint block);
  /// How many triangles the splits at some places of a page add. Throws PageLost. Several readers may do this
  /// at the same time where pages are not loaded.
  void find_changes(int lod, LatticePoint block, std::span<const std::uint16_t> places,
                    std::span<std::int16_t> changes);
  /// Finds that of the groups before `groups`.
  void count(int lod, LatticePoint block, std::size_t groups, CrossedPage& page);

 private:
  /// What there is by codes_.
  [[nodiscard]] CrossedPage page_of_codes() const;

  StoredDiamonds<Sample>& diamonds_;
  PageTriangleCounter<Sample> counter_;
  typename StoredDiamonds<Sample>::Codes codes_;
};

extern template class CrossedPageReader<std::uint8_t>;
extern template class CrossedPageReader<std::uint16_t>;
extern template class CrossedPageReader<std::int16_t>;
extern template class CrossedPageReader<float>;

}  // namespace adamas::isosurface
