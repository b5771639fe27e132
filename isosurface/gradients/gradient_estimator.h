#pragma once

#include <array>
#include <cstddef>

#include "adamas/geometry.h"

namespace adamas::isosurface {

/// A stored gradient, in values per unit of length.
using Gradient = std::array<float, 3>;

/// A sample and its 26 neighbours, i running fastest: the neighbour at (di, dj, dk) from -1 to 1 has the
/// index (di + 1) + 3 (dj + 1) + 9 (dk + 1). Missing neighbours, as beyond the border, are NaN.
using Neighbourhood = std::array<double, 27>;

constexpr std::size_t neighbour(int di, int dj, int dk) {
  return static_cast<std::size_t>((di + 1) + 3 * (dj + 1) + 9 * (dk + 1));
}

/// Computes gradients of a volume by least squares from the differences along the 13 directions of the 26
/// neighbours (D 4.3.2). The gradient of a linear field is exact, at borders too.
class GradientEstimator {
 public:
  /// Makes an estimator. `spacing` is the distance between samples along each axis, positive.
  explicit GradientEstimator(const Vec3& spacing);

  /// Returns the gradient at the middle, in values per unit of length. A difference is central where both
  /// ends exist, one-sided where only one does, and left out where none does. Components that no difference
  /// determines are 0, and all are where the middle is not finite.
  [[nodiscard]] Vec3 operator()(const Neighbourhood& values) const;
  /// Returns the gradient at the middle if all values are finite: doubles, or integers of 16 bits at most.
  template <class Number>
  [[nodiscard]] Vec3 central(const std::array<Number, 27>& values) const;

 private:
  static constexpr std::size_t kDirections = 13;
  using Differences = std::array<double, kDirections>;

  [[nodiscard]] Vec3 solve(const Differences& slopes) const;

  std::array<Vec3, kDirections> directions_{};  ///< unit vectors
  std::array<double, kDirections> lengths_{};   ///< lengths of the steps to the neighbours
  /// The least-squares solution if all differences are known: the sum of these vectors times the differences
  /// over both steps.
  std::array<Vec3, kDirections> inverse_{};
};

template <class Number>
Vec3 GradientEstimator::central(const std::array<Number, 27>& values) const {
  // Differences of integers stay integers until they are weighted: those of 16 bits fit in an int, and fewer
  // numbers have to be converted.
  const auto difference = [&values](int i, int j, int k) {
    return values[neighbour(i, j, k)] - values[neighbour(-i, -j, -k)];
  };
  // Directions that differ only in signs have weights of the same magnitude.
  const auto x = difference(1, 0, 0), y = difference(0, 1, 0), z = difference(0, 0, 1);
  const auto xy = difference(1, 1, 0), x_y = difference(1, -1, 0), xz = difference(1, 0, 1),
             x_z = difference(1, 0, -1), yz = difference(0, 1, 1), y_z = difference(0, 1, -1);
  const auto a = difference(1, 1, 1), b = difference(1, 1, -1), c = difference(1, -1, 1),
             d = difference(1, -1, -1);
  const auto& w = inverse_;
  return {w[0].x * x + w[3].x * (xy + x_y) + w[5].x * (xz + x_z) + w[9].x * ((a + b) + (c + d)),
          w[1].y * y + w[3].y * (xy - x_y) + w[7].y * (yz + y_z) + w[9].y * ((a + b) - (c + d)),
          w[2].z * z + w[5].z * (xz - x_z) + w[7].z * (yz - y_z) + w[9].z * ((a - b) + (c - d))};
}

}  // namespace adamas::isosurface
