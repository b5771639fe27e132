#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "isosurface/storage/page.h"

/// Before a loop that reads nothing that it writes, which g++ does not see where there are many arrays.
#if defined(__clang__)
#define ADAMAS_INDEPENDENT
#else
#define ADAMAS_INDEPENDENT _Pragma("GCC ivdep")
#endif

namespace adamas {

/// A page and what is round it, by the parity of the coordinates: 11^3 cells of 2^3 points, that of place c
/// (Surroundings) with the points 2 (c - 1) and 2 (c - 1) + 1 along each axis. Bit `axis` of a parity tells
/// that the coordinate along the axis is odd. Numbers are wide enough for sums of a few samples.
template <class Word>
struct InterpolationCells {
  using Value = std::conditional_t<sizeof(Word) == 1, std::int16_t,
                                   std::conditional_t<sizeof(Word) == 2, std::int32_t, std::int64_t>>;
  static constexpr int kPlane = 121;
  static constexpr int kCells = 1331;
  static constexpr std::array<int, 3> kStride{1, 11, kPlane};
  using Cells = std::array<Value, kCells>;

  /// Samples by parity; predictions where the point is another page's.
  std::array<Cells, 8> values;
  /// By parity: magnitudes of the residuals of the samples.
  std::array<Cells, 7> residuals;
  /// Of the parities that are at work: how much the samples vary round the point.
  std::array<Cells, 3> activity;
  /// For the edges: by axis, the difference between each even point and the next; and their sum round a
  /// point.
  std::array<Cells, 3> gradients;
  Cells steps;

  static constexpr int kSets = 3;
  /// The parities of a set, which are predicted together: edges, faces, centres.
  static constexpr std::array<std::array<int, 3>, kSets> kParities{{{1, 2, 4}, {3, 5, 6}, {7, 0, 0}}};
  static constexpr int parities(int set) { return set == 2 ? 1 : 3; }
};

/// The points of one parity in a page: so many per axis, from place 1 on.
struct ParityBox {
  int ni, nj, nk;

  static constexpr ParityBox of(LatticePoint count, int parity) {
    const auto along = [&](int axis) { return (count[axis] + 1 - (parity >> axis & 1)) / 2; };
    return {along(0), along(1), along(2)};
  }
  [[nodiscard]] constexpr int size() const { return ni * nj * nk; }

  /// f(cell, number of points before, points in the row) for each row, with the last one a constant where the
  /// box is whole.
  template <class F>
  void for_each_row(F&& f) const {
    if (size() == 512) {
      rows(std::integral_constant<int, 8>(), 8, 8, f);
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

}  // namespace adamas
