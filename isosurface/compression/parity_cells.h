#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {

/// Numbers of the points of one parity of a page and round it, in 11^3 cells of 2^3 points: the cell at c
/// (Surroundings) has the points 2 (c - 1) and 2 (c - 1) + 1 along each axis, i running fastest. Bit `axis`
/// of a parity is set where the coordinate along the axis is odd.
template <class T>
using ParityCells = std::array<T, 1331>;

/// The numbers of all points, by parity.
template <class T>
using AllCells = std::array<ParityCells<T>, 8>;

inline constexpr std::array<int, 3> kCellStrides{1, 11, 121};
/// The range of the page's own cells, with others between them.
inline constexpr std::size_t kFirstCell = 133, kEndOfCells = 8 * 133 + 1;

/// The cell and parity of the neighbour of a point.
struct CellNeighbour {
  std::size_t parity = 0;
  int offset = 0;  ///< from cell to cell
};

/// Returns the neighbour at d of the points of a parity; d has steps from -1 to 1.
constexpr CellNeighbour cell_neighbour(int parity, LatticePoint d) {
  int other = 0, offset = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int odd = parity >> axis & 1, stride = kCellStrides[static_cast<std::size_t>(axis)];
    other |= (d[axis] == 0 ? odd : 1 - odd) << axis;
    if (d[axis] > 0 && odd == 1) offset += stride;
    if (d[axis] < 0 && odd == 0) offset -= stride;
  }
  return {static_cast<std::size_t>(other), offset};
}

/// The points of one parity in a page: ni, nj and nk along the axes, from place 1 on.
struct ParityBox {
  int ni = 0, nj = 0, nk = 0;

  static constexpr ParityBox for_parity(LatticePoint count, int parity) {
    const auto along = [&](int axis) { return (count[axis] + 1 - (parity >> axis & 1)) / 2; };
    return {along(0), along(1), along(2)};
  }
  [[nodiscard]] constexpr int size() const { return ni * nj * nk; }

  /// Calls f(cell, number of points before, points in the row) for each row; the last argument is a constant
  /// where the rows are whole.
  template <class F>
  void for_each_row(F&& f) const {
    if (ni == 8) {
      rows(std::integral_constant<int, 8>(), nj, nk, f);
    } else {
      rows(ni, nj, nk, f);
    }
  }

 private:
  template <class Row, class F>
  static void rows(Row row, int nj, int nk, F&& f) {
    std::size_t before = 0;
    for (int k = 1; k <= nk; ++k) {
      for (int j = 1; j <= nj; ++j) {
        f(static_cast<std::size_t>(1 + 11 * (j + 11 * k)), before, row);
        before += static_cast<std::size_t>(row);
      }
    }
  }
};

/// Eight bytes of a row of cells, which are computed together; that of the first cell is lowest.
using RowBytes = std::uint64_t;

constexpr RowBytes kEachByte = 0x0101010101010101u;

[[gnu::always_inline]] inline RowBytes load_row(const std::uint8_t* from) {
  RowBytes bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  if constexpr (std::endian::native == std::endian::big) bytes = __builtin_bswap64(bytes);
  return bytes;
}
[[gnu::always_inline]] inline void store_row(RowBytes bytes, std::uint8_t* to) {
  if constexpr (std::endian::native == std::endian::big) bytes = __builtin_bswap64(bytes);
  std::memcpy(to, &bytes, sizeof bytes);
}

/// Returns a mask with all bits of the first `count` bytes, 0 to 8.
constexpr RowBytes first_bytes(int count) {
  return count >= 8 ? ~RowBytes{0} : (RowBytes{1} << 8 * count) - 1;
}
/// Returns a mask with all bits of the bytes that are not 0.
[[gnu::always_inline]] inline RowBytes bytes_not_zero(RowBytes bytes) {
  constexpr RowBytes kLow = kEachByte * 127;
  return ((((bytes & kLow) + kLow) | bytes) >> 7 & kEachByte) * 255;
}
/// Returns the number of bytes in a mask; each byte has all bits or none.
[[gnu::always_inline]] inline std::size_t bytes_in(RowBytes mask) {
  // The highest byte of the product is the sum of all bytes.
  return static_cast<std::size_t>((mask & kEachByte) * kEachByte >> 56);
}

/// Moves the bytes of a mask side by side, from the lowest on. Wide: see with_wide_lanes.
template <bool Wide>
[[gnu::always_inline]] inline RowBytes gather_bytes(RowBytes bytes, RowBytes mask) {
#if defined(__x86_64__)
  if constexpr (Wide) {
    // This is inline assembly, since the compiler's own function cannot be inlined where the target is chosen
    // at run time.
    RowBytes result;
    __asm__("pext %2, %1, %0" : "=r"(result) : "r"(bytes), "r"(mask));
    return result;
  }
#endif
  RowBytes result = 0;
  for (int n = 0, to = 0; n < 64; n += 8) {
    if ((mask >> n & 1) == 0) continue;
    result |= (bytes >> n & 255) << to;
    to += 8;
  }
  return result;
}
/// Moves bytes back to the places of a mask; other bytes are 0.
template <bool Wide>
[[gnu::always_inline]] inline RowBytes spread_bytes(RowBytes bytes, RowBytes mask) {
#if defined(__x86_64__)
  if constexpr (Wide) {
    RowBytes result;
    __asm__("pdep %2, %1, %0" : "=r"(result) : "r"(bytes), "r"(mask));
    return result;
  }
#endif
  RowBytes result = 0;
  for (int n = 0; n < 64; n += 8) {
    if ((mask >> n & 1) == 0) continue;
    result |= (bytes & 255) << n;
    bytes >>= 8;
  }
  return result;
}

}  // namespace adamas::isosurface
