#include "isosurface/volume/page_grid.h"

#include <algorithm>
#include <bit>

#include "core/base/error.h"
#include "isosurface/volume/z_order.h"

namespace adamas::isosurface {

std::string page_name(const PageId& page) {
  return fmt::format("the page of LOD {} at {}, {}, {}", page.lod, page.block.i, page.block.j, page.block.k);
}

PageGrid::PageGrid(const std::array<std::uint64_t, 3>& dimensions) {
  constexpr std::uint64_t kMost = (std::uint64_t{1} << kMaxDepth) + 1;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint64_t n = dimensions[static_cast<std::size_t>(axis)];
    if (n == 0 || n > kMost) fail("expected 1 to {} samples along every axis, found {}", kMost, n);
    last_[axis] = static_cast<std::int32_t>(n - 1);
  }
  const std::int32_t greatest = std::max({last_.i, last_.j, last_.k});
  while ((std::int32_t{1} << depth_) < greatest) ++depth_;
}

std::uint64_t PageGrid::number(const PageId& page) const {
  return std::uint64_t{1} << (3 * (top() - page.lod)) | ZOrder::interleave(page.block);
}

PageId PageGrid::page(std::uint64_t number) const {
  const int finer = (std::bit_width(number) - 1) / 3;
  return {top() - finer, ZOrder::deinterleave(number & ~(std::uint64_t{1} << (3 * finer)))};
}

bool PageGrid::contains(const PageId& page) const {
  if (page.lod < 0 || page.lod > top()) return false;
  const LatticePoint n = blocks(page.lod);
  for (int axis = 0; axis < 3; ++axis) {
    if (page.block[axis] < 0 || page.block[axis] >= n[axis]) return false;
  }
  // A single point, whose coordinates are all even, belongs to a coarser LOD.
  return is_complete(page) || count(page) != LatticePoint{1, 1, 1};
}

std::uint64_t PageGrid::page_count() const {
  std::uint64_t total = 0;
  for (int lod = 0; lod <= top(); ++lod) {
    const LatticePoint n = blocks(lod);
    total +=
        static_cast<std::uint64_t>(n.i) * static_cast<std::uint64_t>(n.j) * static_cast<std::uint64_t>(n.k);
    const PageId corner{lod, {n.i - 1, n.j - 1, n.k - 1}};
    if (!contains(corner)) --total;
  }
  return total;
}

void check_volume_dimensions(const std::string& name, const VolumeGrid& grid) {
  constexpr std::uint64_t kMost = (std::uint64_t{1} << PageGrid::kMaxDepth) + 1;
  for (const std::uint64_t n : grid.dimensions) {
    if (n > kMost) fail("{}: expected at most {} samples along each axis, found {}", name, kMost, n);
  }
}

}  // namespace adamas::isosurface
