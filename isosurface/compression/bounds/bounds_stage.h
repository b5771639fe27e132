#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "isosurface/compression/parity_cells.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// The parities of a page's points in the order in which they are coded: edges, faces, centres.
inline constexpr std::array<int, 7> kCodedParities{1, 2, 4, 3, 5, 6, 7};

/// Returns the phase of the diamonds of a parity's points.
constexpr int phase_of(int parity) { return 3 - (parity & 1) - (parity >> 1 & 1) - (parity >> 2); }

/// Calls f with a coded parity as a constant.
template <class F>
[[gnu::always_inline]] inline void with_parity(int parity, F f) {
  [&]<std::size_t... N>(std::index_sequence<N...>) {
    ((kCodedParities[N] == parity ? f(std::integral_constant<int, kCodedParities[N]>{}) : void()), ...);
  }
  (std::make_index_sequence<kCodedParities.size()>());
}

/// Returns, for each point, the greatest number of the cubes that contain it. `cube`: the cell of the cube
/// whose centre is in the same cell as the first point. Lanes: see Simd.
template <int Parity, class Lanes, class T>
[[gnu::always_inline]] inline typename Lanes::Numbers greatest_of_cubes(const T* cube) {
  typename Lanes::Numbers greatest = Lanes::load(cube);
  [&]<int... N>(std::integer_sequence<int, N...>) {
    const auto take = [&]<int Step>(std::integral_constant<int, Step>) {
      if constexpr (Step != 0 && (Step & Parity) == 0)
        greatest = Lanes::greater(
            greatest, Lanes::load(cube - ((Step & 1) + 11 * (Step >> 1 & 1) + 121 * (Step >> 2))));
    };
    (take(std::integral_constant<int, N>{}), ...);
  }
  (std::make_integer_sequence<int, 8>());
  return greatest;
}

/// The points of a parity whose errors or ranges follow from their page: all samples in and on their
/// diamonds, and all children on the page's LOD, are the page's own. In a store they have the derived values,
/// so they need not be coded; if one point of a page does not, all its points are coded.
class DeterminedPoints {
 public:
  /// The kind of bounds. Errors are determined on the finest LOD alone, and so are the ranges of edges; those
  /// of faces and centres are determined on every LOD.
  enum class Of : std::uint8_t { kErrors, kRanges };

  /// Makes an empty set.
  DeterminedPoints() = default;
  DeterminedPoints(const PageShape& shape, int parity, Of of) {
    /// Masks by axis, with all bits of a cell's byte where its coordinate lets points be determined.
    std::array<RowBytes, 3> along{};
    for (int axis = 0; axis < 3; ++axis) {
      const int odd = parity >> axis & 1;
      for (std::int32_t c = 0; c < 8; ++c) {
        if (is_determined(2 * c + odd, shape.count[axis], phase_of(parity), of))
          along[static_cast<std::size_t>(axis)] |= RowBytes{255} << 8 * c;
      }
    }
    const ParityBox box = ParityBox::of(shape.count, parity);
    std::size_t n = 0;
    for (int k = 0; k < box.nk; ++k) {
      for (int j = 0; j < box.nj; ++j)
        rows_[n++] = (along[1] >> 8 * j & along[2] >> 8 * k & 1) != 0 ? along[0] : 0;
    }
  }

  /// Returns a mask of the determined points of the nth row of the parity's points.
  [[nodiscard]] RowBytes row(std::size_t n) const { return rows_[n]; }

 private:
  /// Returns whether a coordinate lets points be determined, where the page has `count` of them.
  static bool is_determined(std::int32_t x, std::int32_t count, int phase, Of of) {
    const bool odd = (x & 1) != 0;
    // Samples of edges and faces, and children of all diamonds, lie in the cubes on both sides.
    if (of == Of::kErrors) return odd ? phase == 2 || x + 1 < count : x > 0 && x + 1 < count;
    // The range of an edge depends on samples, some of which may lie before the page; that of others on
    // children, some of which may lie behind it.
    if (phase == 2) return odd || x > 0;
    return !odd || x < PageGrid::kSide - 1 || count < PageGrid::kSide;
  }

  std::array<RowBytes, 64> rows_{};
};

/// The points of a parity that are coded, one after another.
struct BoundsStage {
  static constexpr std::size_t kMost = 512, kSlack = 8;

  int parity = 0;
  ParityBox box;
  std::size_t base = 0;                                 ///< the offset of the contexts
  std::size_t size = 0;                                 ///< number of coded points
  std::array<std::uint8_t, kMost + kSlack> contexts{};  ///< the contexts of these points, row by row
  std::array<RowBytes, 64> coded{};                     ///< masks of the points that are coded, by row

  void begin(int of, const ParityBox& points) {
    parity = of;
    box = points;
    size = 0;
  }
  /// Adds all rows. row(cell, mask of the determined points) returns the contexts of the row's points, and a
  /// mask of those that are coded. Wide: see with_wide_lanes.
  template <bool Wide, class Row>
  void add_rows(const DeterminedPoints& points, Row row);
};

template <bool Wide, class Row>
void BoundsStage::add_rows(const DeterminedPoints& points, Row row) {
  std::size_t n = 0;
  box.for_each_row([&](std::size_t cell, std::size_t, int count) {
    const auto [all_contexts, all_coded] = row(cell, points.row(n));
    const RowBytes those = all_coded & first_bytes(count);
    coded[n++] = those;
    store_row(gather_bytes<Wide>(all_contexts, those), contexts.data() + size);
    size += bytes_in(those);
  });
}

}  // namespace adamas::isosurface
