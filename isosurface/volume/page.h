#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// One value for each of the 16^3 points of a page's cube, those of coarser LODs included, by place (i
/// running fastest). Places beyond PageGrid::count are undefined.
template <class T>
using PagePoints = std::array<T, PageGrid::kPoints>;

/// Other bytes that the coded samples of a page carry along without getting longer.
using BytesAlong = std::array<std::byte, 20>;

/// The samples of a page. Word: OrderedWord of the samples' type.
template <class Word>
struct PageSamples {
  PagePoints<Word> samples;
  BytesAlong along;  ///< the first bytes of the coded bounds, for a page of a store
};

/// The bounds of the diamonds of a page's points.
template <class Word>
struct PageBounds {
  /// The least and the greatest finite sample in and on each diamond, as words; low > high where there is
  /// none.
  PagePoints<Word> low, high;
  /// Each diamond's isosurface error, as a code of its LOD's ErrorScale.
  PagePoints<std::uint8_t> errors;
};

template <class Word>
struct Page : PageSamples<Word>, PageBounds<Word> {};

enum class PageParts : std::uint8_t { kSamples = 1, kBounds = 2, kAll = 3 };

constexpr bool has_part(PageParts parts, PageParts part) {
  return (static_cast<int>(parts) & static_cast<int>(part)) != 0;
}

/// The points that predict a page: those of the next coarser LOD in and round its cube, i running fastest.
/// Along each axis the place c from 0 to kSide - 1 is the point 16 block + 2 (c - 1) of the page's LOD: these
/// are the even points from the one before the page to the second behind its last one. Beyond the data's
/// extent they repeat the last point before it. Bounds are known at the places from 1 to 9, as far as they
/// lie on the coarser page that covers the cube; other places have bounds that exclude nothing.
template <class Word>
struct Surroundings {
  static constexpr int kSide = 11;
  static constexpr std::size_t kPoints = 1331;
  static constexpr std::uint8_t kNoBound = 63;  ///< the code of the greatest error
  template <class T>
  using Points = std::array<T, kPoints>;

  Points<Word> samples, low, high;
  Points<std::uint8_t> errors;  ///< codes on the scale of the LOD of the point's diamond
};

/// Returns the place in Surroundings of the point at `q` of the page, whose coordinates are even.
constexpr std::size_t surrounding_place(LatticePoint q) {
  return static_cast<std::size_t>((q.i / 2 + 1) + 11 * ((q.j / 2 + 1) + 11 * (q.k / 2 + 1)));
}

/// The properties of a page that codecs know before they see its points.
struct PageShape {
  LatticePoint count;  ///< PageGrid::count
  bool complete;       ///< PageGrid::is_complete
  int lod;             ///< PageId::lod

  /// Returns whether the point at q is the page's own, which it keeps in the file, and not one of a coarser
  /// LOD.
  [[nodiscard]] bool owns(LatticePoint q) const {
    return q.i < count.i && q.j < count.j && q.k < count.k && (complete || ((q.i | q.j | q.k) & 1) != 0);
  }
};

inline PageShape page_shape(const PageGrid& grid, const PageId& page) {
  return {grid.count(page), grid.is_complete(page), page.lod};
}

/// Calls f(place) for the page's own points, i running fastest.
template <class F>
void for_each_own_place(const PageShape& shape, F&& f) {
  const auto at = [](std::int32_t x) { return static_cast<std::size_t>(x); };
  for (std::int32_t k = 0; k < shape.count.k; ++k) {
    for (std::int32_t j = 0; j < shape.count.j; ++j) {
      const bool has_coarser = !shape.complete && ((j | k) & 1) == 0;
      const std::size_t row = PageGrid::place({0, j, k}, 0), end = row + at(shape.count.i);
      for (std::size_t n = row + (has_coarser ? 1 : 0); n < end; n += has_coarser ? 2 : 1) f(n);
    }
  }
}

/// Returns whether the page's own points have the same bounds in two pages of a shape.
template <class Word>
bool are_same_bounds(const PageShape& shape, const PageBounds<Word>& a, const PageBounds<Word>& b) {
  bool same = true;
  for_each_own_place(shape, [&](std::size_t place) {
    same = same && a.low[place] == b.low[place] && a.high[place] == b.high[place] &&
           a.errors[place] == b.errors[place];
  });
  return same;
}

}  // namespace adamas::isosurface
