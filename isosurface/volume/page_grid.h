#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "core/lattice/lattice_point.h"

namespace adamas {

/// Which page: the points that a level adds in a cube of 16^3 points of the level. The points of level l are
/// those whose coordinates, which count samples, are multiples of 2^l.
struct PageId {
  int level = 0;
  LatticePoint block{};  ///< the cube: points of the level from 16 block to 16 block + 15 per axis

  bool operator==(const PageId&) const = default;
};

/// "the page of level 0 at 1, 2, 3", as messages speak of it.
std::string page_name(const PageId& page);

/// How the points of a volume lie in pages (D 4.5): the sequence of hierarchical z-order, cut where cubes of
/// 16^3 points end, so that every page is compact in space. The coarsest level is a page by itself.
///
/// Along an axis whose last sample is `last`, level l has the points 0 to ceil(last / 2^l): where 2^l does
/// not divide `last`, the last of them is virtual. It lies beyond the data, and its sample is the nearest
/// one, so that what is known of a level needs no page of a finer one. The diamonds of all other points
/// beyond the data lie wholly outside. The coarsest page has what all coarser levels need.
class PageGrid {
 public:
  static constexpr int kSide = 16;
  static constexpr std::size_t kPoints = 4096;
  static constexpr int kMaxDepth = 18;

  /// Throws Error where there is no sample or an axis has more than 2^kMaxDepth + 1.
  explicit PageGrid(const std::array<std::uint64_t, 3>& dimensions);

  /// n, the least with 2^n >= the greatest dimension - 1: the diamonds' lattice is a cube of that side.
  [[nodiscard]] int depth() const { return depth_; }
  /// The coarsest level that has a page of its own, with all points of this level and coarser ones.
  [[nodiscard]] int top() const { return depth_ > 3 ? depth_ - 3 : 0; }
  /// The last sample.
  [[nodiscard]] LatticePoint last() const { return last_; }

  /// The greatest coordinates of the level's points, in units of 2^level.
  [[nodiscard]] LatticePoint extent(int level) const {
    const LatticePoint e = reach(level);
    return level == top() && depth_ > 0 ? (1 << (depth_ - 1 - level)) * reach(depth_ - 1) : e;
  }
  /// The greatest coordinates, in units of 2^level, of the points whose diamonds of that scale are not wholly
  /// outside; not more than extent(level).
  [[nodiscard]] LatticePoint reach(int level) const {
    const auto at = [level](std::int32_t x) { return (x + (1 << level) - 1) >> level; };
    return {at(last_.i), at(last_.j), at(last_.k)};
  }
  /// Number of pages of the level per axis.
  [[nodiscard]] LatticePoint blocks(int level) const {
    const LatticePoint e = extent(level);
    return {e.i / kSide + 1, e.j / kSide + 1, e.k / kSide + 1};
  }
  /// Number of points of the level in the page per axis, virtual ones included: 1 to 16.
  [[nodiscard]] LatticePoint count(const PageId& page) const {
    const LatticePoint e = extent(page.level);
    const auto at = [](std::int32_t end, std::int32_t block) {
      return end - kSide * block + 1 < kSide ? end - kSide * block + 1 : kSide;
    };
    return {at(e.i, page.block.i), at(e.j, page.block.j), at(e.k, page.block.k)};
  }
  /// Whether the points of a page are all those of its level in its cube, not only those that the level adds.
  [[nodiscard]] bool is_complete(const PageId& page) const { return page.level == top(); }

  /// The level whose pages have the point.
  [[nodiscard]] int level(LatticePoint p) const {
    const int zeros = trailing_zeros(p);
    return zeros < top() ? zeros : top();
  }
  /// Which page has the point.
  [[nodiscard]] PageId page(LatticePoint p) const {
    const int l = level(p);
    return {l, {p.i >> (l + 4), p.j >> (l + 4), p.k >> (l + 4)}};
  }
  /// Place of a level's point in its page, i running fastest.
  static constexpr std::size_t place(LatticePoint p, int level) {
    const auto at = [level](std::int32_t x) { return static_cast<std::size_t>(x >> level & (kSide - 1)); };
    return at(p.i) + kSide * (at(p.j) + kSide * at(p.k));
  }
  /// Whether the point at this place of a page that is not complete belongs to coarser levels.
  static constexpr bool is_coarser(std::size_t place) { return (place & 0x111) == 0; }

  /// A number for each page, in the order of pages in files: 1 for the coarsest, and eight times as many with
  /// each level, where they follow the z-order of their cubes.
  [[nodiscard]] std::uint64_t number(const PageId& page) const;
  [[nodiscard]] PageId page(std::uint64_t number) const;
  /// Whether the page's points begin inside the levels' extents: only such pages exist.
  [[nodiscard]] bool contains(const PageId& page) const;
  /// Pages of all levels.
  [[nodiscard]] std::uint64_t page_count() const;

 private:
  int depth_ = 0;
  LatticePoint last_{};
};

}  // namespace adamas
