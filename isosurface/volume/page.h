#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "isosurface/volume/page_grid.h"

namespace adamas {

/// Something of a page's points: of all 16^3 of its cube, those of coarser LODs too, by place (i running
/// fastest). Places beyond PageGrid::count hold anything.
template <class T>
using PagePoints = std::array<T, PageGrid::kPoints>;

/// Word: OrderedWord of the samples' type.
template <class Word>
struct PageSamples {
  PagePoints<Word> samples;
};

/// What is known of the points' diamonds.
template <class Word>
struct PageBounds {
  /// The least and the greatest sample in and on it, NaN and infinities left out; low > high where nothing is
  /// left.
  PagePoints<Word> low, high;
  /// Its isosurface error, as a code of its LOD's ErrorScale.
  PagePoints<std::uint8_t> errors;
};

template <class Word>
struct Page : PageSamples<Word>, PageBounds<Word> {};

enum class PageParts : std::uint8_t { kSamples = 1, kBounds = 2, kAll = 3 };

constexpr bool has_part(PageParts parts, PageParts part) {
  return (static_cast<int>(parts) & static_cast<int>(part)) != 0;
}

/// What the points of a page are predicted from: those of the next coarser LOD, round the page. Along each
/// axis the place c from 0 to kSide - 1 is the point 16 block + 2 (c - 1) of the page's LOD: one before the
/// page to two behind its last even point. Points beyond the data's extent repeat the last one before them.
/// i runs fastest. Of errors and ranges those of the places from 1 to 9 are known, as far as one page has all
/// of them, that with the page's own points; elsewhere stands what bounds nothing.
template <class Word>
struct Surroundings {
  static constexpr int kSide = 11;
  static constexpr std::size_t kPoints = 1331;
  static constexpr std::uint8_t kNoBound = 63;  ///< as a code of an error
  template <class T>
  using Points = std::array<T, kPoints>;

  Points<Word> samples, low, high;
  Points<std::uint8_t> errors;  ///< codes, of the LOD that the diamond of each point has
};

/// Place in Surroundings of the point that lies at `q` of the page, whose coordinates are even.
constexpr std::size_t surrounding_place(LatticePoint q) {
  return static_cast<std::size_t>((q.i / 2 + 1) + 11 * ((q.j / 2 + 1) + 11 * (q.k / 2 + 1)));
}

/// A page of which one part after another becomes known, as who codes it sees it.
struct PageShape {
  LatticePoint count;  ///< PageGrid::count
  bool complete;       ///< PageGrid::is_complete
  int lod;             ///< PageId::lod

  /// Whether a place has a point that is the page's own: whose values the page keeps.
  [[nodiscard]] bool owns(LatticePoint q) const {
    return q.i < count.i && q.j < count.j && q.k < count.k && (complete || ((q.i | q.j | q.k) & 1) != 0);
  }
};

inline PageShape page_shape(const PageGrid& grid, const PageId& page) {
  return {grid.count(page), grid.is_complete(page), page.lod};
}

/// f(place) for the page's own points, i running fastest.
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

}  // namespace adamas
