#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "core/lattice/lattice_point.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// Returns which of the pages round a page has a point, in the order of step_around(). The point is counted
/// from the page's first one, and is at most a page away.
constexpr std::size_t page_around(LatticePoint q) {
  return static_cast<std::size_t>((q.i >> 4) + 1 + 3 * ((q.j >> 4) + 1) + 9 * ((q.k >> 4) + 1));
}

/// A set of the diamonds of a page: bit i of row j + 16 k is the diamond at (i, j, k).
struct PageMask {
  std::array<std::uint16_t, std::size_t{PageGrid::kSide} * PageGrid::kSide> rows{};

  bool operator==(const PageMask&) const = default;

  [[nodiscard]] bool has(LatticePoint q) const {
    return (rows[static_cast<std::size_t>(q.j + PageGrid::kSide * q.k)] >> q.i & 1) != 0;
  }
  /// Adds the diamond at a place, PageGrid::place(q, 0).
  void add(std::uint16_t place) {
    std::uint16_t& row = rows[place / PageGrid::kSide];
    row = static_cast<std::uint16_t>(row | 1u << place % PageGrid::kSide);
  }
  void remove(std::uint16_t place) {
    std::uint16_t& row = rows[place / PageGrid::kSide];
    row = static_cast<std::uint16_t>(row & ~(1u << place % PageGrid::kSide));
  }
  [[nodiscard]] bool any() const {
    return std::any_of(rows.begin(), rows.end(), [](std::uint16_t row) { return row != 0; });
  }
  [[nodiscard]] std::size_t count() const {
    // Bits are counted in fields of two, four and eight bits, and summed up in fields of 16.
    std::uint64_t sum = 0;
    for (std::size_t row = 0; row < rows.size(); row += 4) {
      std::uint64_t four;
      std::memcpy(&four, rows.data() + row, sizeof four);
      four -= four >> 1 & 0x5555555555555555u;
      four = (four & 0x3333333333333333u) + (four >> 2 & 0x3333333333333333u);
      four = (four + (four >> 4)) & 0x0f0f0f0f0f0f0f0fu;
      sum += (four & 0x00ff00ff00ff00ffu) + (four >> 8 & 0x00ff00ff00ff00ffu);
    }
    return (sum & 0xffff) + (sum >> 16 & 0xffff) + (sum >> 32 & 0xffff) + (sum >> 48);
  }
  /// Calls visit(q) for each diamond of the set, i running fastest.
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (unsigned bits = rows[row]; bits != 0; bits &= bits - 1) {
        visit(LatticePoint{std::countr_zero(bits), static_cast<std::int32_t>(row % PageGrid::kSide),
                           static_cast<std::int32_t>(row / PageGrid::kSide)});
      }
    }
  }
};

}  // namespace adamas::isosurface
