#pragma once

#include <array>
#include <cstddef>

#include "core/lattice/lattice_point.h"

namespace adamas {

/// Samples as numbers, of a page's points and of those one step round them: coordinates from -1 to 16. In
/// each row along i the points with an odd coordinate come first, then those with an even one, so that the
/// points of one kind follow each other.
class HeightGrid {
 public:
  static constexpr std::ptrdiff_t kHalf = 9, kSide = 2 * kHalf;

  void fill(float height) { heights_.fill(height); }

  [[nodiscard]] const float* at(LatticePoint q) const { return heights_.data() + index(q); }
  [[nodiscard]] float* at(LatticePoint q) { return heights_.data() + index(q); }

  /// From a point to its neighbours before and behind it along an axis.
  struct Steps {
    std::ptrdiff_t before, after;
  };
  static constexpr Steps steps(LatticePoint from, int axis) {
    if (axis == 0) return (from.i & 1) != 0 ? Steps{kHalf - 1, kHalf} : Steps{-kHalf, 1 - kHalf};
    const std::ptrdiff_t step = axis == 1 ? kSide : kSide * kSide;
    return {-step, step};
  }

 private:
  static constexpr std::size_t index(LatticePoint q) {
    const std::ptrdiff_t i = (q.i & 1) != 0 ? (q.i + 1) / 2 : kHalf + q.i / 2;
    return static_cast<std::size_t>(i + kSide * ((q.j + 1) + kSide * (q.k + 1)));
  }

  std::array<float, kSide * kSide * kSide> heights_;
};

}  // namespace adamas
