#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "adamas/volume.h"
#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// Names a page: the points that an LOD adds to coarser ones in a cube of 16^3 of its points. An LOD (level
/// of detail) has those points whose coordinates, which count samples, are multiples of 2^lod. So LOD 0 has
/// all samples, whereas level 0 of diamonds is the coarsest.
struct PageId {
  int lod = 0;
  LatticePoint block{};  ///< the cube: points of the LOD from 16 block to 16 block + 15 per axis

  bool operator==(const PageId&) const = default;
};

/// Returns "the page of LOD 0 at 1, 2, 3", for messages.
std::string page_name(const PageId& page);

/// The division of a volume's points into pages (D 4.5): the sequence of hierarchical z-order, divided where
/// cubes of 16^3 points end, so that every page is compact in space. The coarsest LOD is a page by itself.
///
/// Along an axis whose last sample is `last`, LOD l has the points 0 to ceil(last / 2^l): if 2^l does not
/// divide `last`, the last of them is virtual. It lies beyond the data, and its sample is the nearest one, so
/// that no LOD depends on a page of a finer one. The diamonds of all other points beyond the data lie wholly
/// outside. The coarsest page has the points of all coarser LODs.
class PageGrid {
 public:
  static constexpr int kSide = 16;
  static constexpr std::size_t kPoints = 4096;
  static constexpr int kMaxDepth = 18;

  /// Makes a grid. Throws Error where there is no sample or an axis has more than 2^kMaxDepth + 1.
  explicit PageGrid(const std::array<std::uint64_t, 3>& dimensions);

  /// Returns the least n with 2^n >= the greatest dimension - 1. The lattice of the diamonds is a cube of
  /// side 2^n.
  [[nodiscard]] int depth() const { return depth_; }
  /// Returns the coarsest LOD that has a page of its own, with all points of this LOD and coarser ones.
  [[nodiscard]] int top() const { return depth_ > 3 ? depth_ - 3 : 0; }
  /// Returns the last sample.
  [[nodiscard]] LatticePoint last() const { return last_; }

  /// Returns the greatest coordinates of the LOD's points, in units of 2^lod.
  [[nodiscard]] LatticePoint extent(int lod) const {
    const LatticePoint e = reach(lod);
    return lod == top() && depth_ > 0 ? (1 << (depth_ - 1 - lod)) * reach(depth_ - 1) : e;
  }
  /// Returns the greatest coordinates, in units of 2^lod, of the points whose diamonds of that scale are not
  /// wholly outside; not more than extent(lod).
  [[nodiscard]] LatticePoint reach(int lod) const {
    const auto at = [lod](std::int32_t x) { return (x + (1 << lod) - 1) >> lod; };
    return {at(last_.i), at(last_.j), at(last_.k)};
  }
  /// Returns the number of pages of the LOD per axis.
  [[nodiscard]] LatticePoint blocks(int lod) const {
    const LatticePoint e = extent(lod);
    return {e.i / kSide + 1, e.j / kSide + 1, e.k / kSide + 1};
  }
  /// Returns the number of points of the LOD in the page per axis, virtual ones included: 1 to 16.
  [[nodiscard]] LatticePoint count(const PageId& page) const {
    const LatticePoint e = extent(page.lod);
    const auto at = [](std::int32_t end, std::int32_t block) {
      return end - kSide * block + 1 < kSide ? end - kSide * block + 1 : kSide;
    };
    return {at(e.i, page.block.i), at(e.j, page.block.j), at(e.k, page.block.k)};
  }
  /// Returns whether the points of a page are all those of its LOD in its cube, not only those that the LOD
  /// adds.
  [[nodiscard]] bool is_complete(const PageId& page) const { return page.lod == top(); }

  [[nodiscard]] int lod(LatticePoint p) const {
    const int zeros = trailing_zeros(p);
    return zeros < top() ? zeros : top();
  }
  [[nodiscard]] PageId page(LatticePoint p) const {
    const int l = lod(p);
    return {l, {p.i >> (l + 4), p.j >> (l + 4), p.k >> (l + 4)}};
  }
  /// Returns the place of an LOD's point in its page, i running fastest.
  static constexpr std::size_t place(LatticePoint p, int lod) {
    const auto at = [lod](std::int32_t x) { return static_cast<std::size_t>(x >> lod & (kSide - 1)); };
    return at(p.i) + kSide * (at(p.j) + kSide * at(p.k));
  }

  /// Returns a number for each page, in the order of pages in files: 1 for the coarsest, and eight times as
  /// many with each LOD, in the z-order of their cubes.
  [[nodiscard]] std::uint64_t number(const PageId& page) const;
  [[nodiscard]] PageId page(std::uint64_t number) const;
  /// Returns whether the page's points begin inside the LODs' extents: only such pages exist.
  [[nodiscard]] bool contains(const PageId& page) const;
  /// Returns the number of pages of all LODs.
  [[nodiscard]] std::uint64_t page_count() const;

 private:
  int depth_ = 0;
  LatticePoint last_{};
};

/// Throws Error, which begins with `name`, where a volume has more samples along an axis than pages allow.
void check_volume_dimensions(const std::string& name, const VolumeGrid& grid);

}  // namespace adamas::isosurface
