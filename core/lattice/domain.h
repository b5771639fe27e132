#pragma once

#include <array>
#include <cstdint>

#include "adamas/geometry.h"
#include "core/lattice/lattice_point.h"

namespace adamas::inline core {

/// A box in space divided into a x b x c root cubes, each of side 2^kRootBits lattice units, with its own
/// spacing per axis (D 2). Neighbouring roots are mirror images of each other.
class Domain {
 public:
  static constexpr int kRootBits = adamas::kRootBits;
  static constexpr int kMaxRoots = 64;  ///< per axis, so that coordinates stay below 2^30

  /// Throws Error for an empty, inverted or non-finite box, one too small or too large for sound volumes or
  /// too thin for where it lies, and for numbers of roots outside [1, kMaxRoots].
  Domain(const Box3& box, std::array<int, 3> roots);
  /// Divides a box so that the shortest axis gets one root cube and the others up to `max_roots`, with the
  /// least ratio of the longest to the shortest side of a root; of equally good numbers the smallest are
  /// taken.
  static Domain fit(const Box3& box, int max_roots = 32);

  [[nodiscard]] const Box3& box() const { return box_; }
  [[nodiscard]] std::array<int, 3> roots() const { return roots_; }
  /// The lattice point of the box's maximum; the minimum is the origin.
  [[nodiscard]] LatticePoint extent() const { return extent_; }
  /// Sides of a lattice cell.
  [[nodiscard]] Vec3 spacing() const { return spacing_; }
  /// Diamonds of levels below this can be split; at most kRootBits - 1, less where the box is so thin for its
  /// distance from the origin that positions would merge.
  [[nodiscard]] int depth() const { return depth_; }

  /// The position of a lattice point; exact at the box's corners.
  [[nodiscard]] Vec3 position(LatticePoint p) const {
    return {coordinate(p.i, 0), coordinate(p.j, 1), coordinate(p.k, 2)};
  }
  [[nodiscard]] bool contains(LatticePoint p) const {
    return p.i >= 0 && p.j >= 0 && p.k >= 0 && p.i <= extent_.i && p.j <= extent_.j && p.k <= extent_.k;
  }
  /// The number of the box's pairs of opposite sides on which p lies: 0 inside, 1 on a face, 2 on an edge, 3
  /// on a corner.
  [[nodiscard]] int boundary_count(LatticePoint p) const {
    return static_cast<int>(p.i == 0 || p.i == extent_.i) + static_cast<int>(p.j == 0 || p.j == extent_.j) +
           static_cast<int>(p.k == 0 || p.k == extent_.k);
  }

  /// R of docs/method.md: the diameter in space of the whole diamond split at p, or a root cube's for the
  /// corner of one. No tetrahedron that can ever have the vertex p has a greater one.
  [[nodiscard]] double diameter(LatticePoint p) const;
  /// Whether the diamond at p has a level below depth(), so that it can be split.
  [[nodiscard]] bool can_split(LatticePoint p) const { return trailing_zeros(p) >= kRootBits - depth_; }

 private:
  [[nodiscard]] double coordinate(std::int32_t x, int axis) const {
    const double w = static_cast<double>(x) / extent_[axis];
    return (1 - w) * box_.min[axis] + w * box_.max[axis];
  }

  Box3 box_;
  std::array<int, 3> roots_;
  LatticePoint extent_{};
  Vec3 spacing_;
  int depth_ = kRootBits - 1;
};

}  // namespace adamas::inline core
