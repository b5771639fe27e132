#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "isosurface/compression/parity_cells.h"
#include "isosurface/compression/sample_depth.h"

namespace adamas {

/// A page and what is round it, by the parity of the coordinates.
template <class Depth>
struct InterpolationCells {
  using Value = typename Depth::Value;
  static constexpr std::array<int, 3> kStride = kCellStrides;
  static constexpr int kPlane = kStride[2];
  using Cells = ParityCells<Value>;
  static constexpr int kCells = std::tuple_size_v<Cells>;

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

}  // namespace adamas
