#pragma once

#include <array>

#include "core/lattice/diamond.h"
#include "core/lattice/lattice_point.h"

namespace adamas {

/// A tetrahedron that bisection makes of a lattice cube of side 2^depth, and the larger ones that it is part
/// of. Coordinates count samples.
class Ancestor {
 public:
  Ancestor(const std::array<LatticePoint, 4>& corners, LatticePoint split_vertex, int depth)
      : corners_(corners), split_vertex_(split_vertex), depth_(depth) {}

  [[nodiscard]] const std::array<LatticePoint, 4>& corners() const { return corners_; }
  /// Of the diamond that the tetrahedron belongs to.
  [[nodiscard]] LatticePoint split_vertex() const { return split_vertex_; }
  [[nodiscard]] int scale_bits() const { return trailing_zeros(split_vertex_); }

  /// Goes on to the tetrahedron of which this one is a half; false where this one is not made by bisection.
  bool ascend() {
    LatticePoint* newest = nullptr;
    int latest = -1;
    for (LatticePoint& c : corners_) {
      const int zeros = trailing_zeros(c);
      if (zeros >= depth_) continue;
      const int generation = 3 * (depth_ - zeros) + 3 - odd_count(c, zeros);
      if (generation > latest) newest = &c, latest = generation;
    }
    if (newest == nullptr) return false;
    // The newest corner split the larger tetrahedron, and took the place of one end of the split edge.
    const LatticePoint middle = *newest;
    const int zeros = trailing_zeros(middle);
    const LatticePoint half =
        (1 << zeros) * split_direction({middle.i >> zeros, middle.j >> zeros, middle.k >> zeros});
    bool has_upper = false;
    for (const LatticePoint c : corners_) has_upper = has_upper || c == middle + half;
    *newest = has_upper ? middle - half : middle + half;
    split_vertex_ = middle;
    return true;
  }

 private:
  static int odd_count(LatticePoint p, int zeros) {
    return (p.i >> zeros & 1) + (p.j >> zeros & 1) + (p.k >> zeros & 1);
  }

  std::array<LatticePoint, 4> corners_;
  LatticePoint split_vertex_;
  int depth_;
};

}  // namespace adamas
