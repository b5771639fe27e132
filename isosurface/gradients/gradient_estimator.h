#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/vec3.h"

namespace adamas {

/// A sample and its 26 neighbours, i running fastest: the neighbour at (di, dj, dk) from -1 to 1 is
/// (di + 1) + 3 (dj + 1) + 9 (dk + 1). Those that are not there, as beyond the border, are NaN.
using Neighbourhood = std::array<double, 27>;

constexpr std::size_t neighbour(int di, int dj, int dk) {
  return static_cast<std::size_t>((di + 1) + 3 * (dj + 1) + 9 * (dk + 1));
}

/// Gradients of a volume by least squares from the differences along the 13 directions of the 26 neighbours
/// (D 4.3.2). A linear field gives its own gradient, at borders too.
class GradientEstimator {
 public:
  /// `spacing`: between samples, positive.
  explicit GradientEstimator(const Vec3& spacing);

  /// The gradient at the middle, in values per unit of length. A difference is central where both ends are
  /// there, one-sided where one is, and left out where none is. Components that no difference tells anything
  /// about are 0, and all are where the middle is not finite.
  [[nodiscard]] Vec3 operator()(const Neighbourhood& values) const;

 private:
  static constexpr std::size_t kDirections = 13;
  using Differences = std::array<double, kDirections>;

  /// Where all of the values are finite.
  [[nodiscard]] Vec3 central(const Neighbourhood& values) const;
  [[nodiscard]] Vec3 solve(const Differences& slopes) const;

  std::array<Vec3, kDirections> directions_{};  ///< unit vectors
  std::array<double, kDirections> lengths_{};   ///< of the steps to the neighbours
  /// The least-squares solution is this times the differences over both steps where all are known.
  std::array<Vec3, kDirections> inverse_{};
};

}  // namespace adamas
