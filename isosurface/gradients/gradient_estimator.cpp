#include "isosurface/gradients/gradient_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adamas {

namespace {

/// One of each pair of opposite steps.
constexpr std::array<std::array<int, 3>, 13> kSteps = {{{1, 0, 0},
                                                        {0, 1, 0},
                                                        {0, 0, 1},
                                                        {1, 1, 0},
                                                        {1, -1, 0},
                                                        {1, 0, 1},
                                                        {1, 0, -1},
                                                        {0, 1, 1},
                                                        {0, 1, -1},
                                                        {1, 1, 1},
                                                        {1, 1, -1},
                                                        {1, -1, 1},
                                                        {1, -1, -1}}};

/// Below this part of the greatest, a pivot is round-off.
constexpr double kSingular = 1e-10;

/// The solution of a symmetric system that is at least semidefinite, by elimination with the greatest pivot
/// first; unknowns that the rest tells nothing about are 0.
Vec3 solve_symmetric(std::array<Vec3, 3> rows, Vec3 right) {
  std::array<int, 3> order{0, 1, 2};
  const double greatest = std::max({rows[0].x, rows[1].y, rows[2].z});
  int rank = 0;
  for (; rank < 3; ++rank) {
    const auto pivot = std::max_element(order.begin() + rank, order.end(), [&](int a, int b) {
      return rows[static_cast<std::size_t>(a)][a] < rows[static_cast<std::size_t>(b)][b];
    });
    std::iter_swap(order.begin() + rank, pivot);
    const int p = order[static_cast<std::size_t>(rank)];
    const Vec3 row = rows[static_cast<std::size_t>(p)];
    if (!(row[p] > kSingular * greatest)) break;
    for (int r = rank + 1; r < 3; ++r) {
      const int other = order[static_cast<std::size_t>(r)];
      const double factor = rows[static_cast<std::size_t>(other)][p] / row[p];
      rows[static_cast<std::size_t>(other)] += -factor * row;
      right[other] -= factor * right[p];
    }
  }
  Vec3 result;
  for (int r = rank - 1; r >= 0; --r) {
    const int p = order[static_cast<std::size_t>(r)];
    const Vec3& row = rows[static_cast<std::size_t>(p)];
    result[p] = (right[p] - dot(row, result)) / row[p];
  }
  return result;
}

}  // namespace

GradientEstimator::GradientEstimator(const Vec3& spacing) {
  std::array<Vec3, 3> matrix{};
  for (std::size_t s = 0; s < kDirections; ++s) {
    const Vec3 step{kSteps[s][0] * spacing.x, kSteps[s][1] * spacing.y, kSteps[s][2] * spacing.z};
    lengths_[s] = norm(step);
    directions_[s] = (1 / lengths_[s]) * step;
    for (int axis = 0; axis < 3; ++axis)
      matrix[static_cast<std::size_t>(axis)] += directions_[s][axis] * directions_[s];
  }
  for (std::size_t s = 0; s < kDirections; ++s)
    inverse_[s] = 0.5 / lengths_[s] * solve_symmetric(matrix, directions_[s]);
}

Vec3 GradientEstimator::central(const Neighbourhood& values) const {
  const auto difference = [&values](int i, int j, int k) {
    return values[neighbour(i, j, k)] - values[neighbour(-i, -j, -k)];
  };
  // Steps that differ in nothing but signs have weights of the same size.
  const double x = difference(1, 0, 0), y = difference(0, 1, 0), z = difference(0, 0, 1);
  const double xy = difference(1, 1, 0), x_y = difference(1, -1, 0), xz = difference(1, 0, 1),
               x_z = difference(1, 0, -1), yz = difference(0, 1, 1), y_z = difference(0, 1, -1);
  const double a = difference(1, 1, 1), b = difference(1, 1, -1), c = difference(1, -1, 1),
               d = difference(1, -1, -1);
  const auto& w = inverse_;
  return {w[0].x * x + w[3].x * (xy + x_y) + w[5].x * (xz + x_z) + w[9].x * ((a + b) + (c + d)),
          w[1].y * y + w[3].y * (xy - x_y) + w[7].y * (yz + y_z) + w[9].y * ((a + b) - (c + d)),
          w[2].z * z + w[5].z * (xz - x_z) + w[7].z * (yz - y_z) + w[9].z * ((a - b) + (c - d))};
}

Vec3 GradientEstimator::operator()(const Neighbourhood& values) const {
  // Of what is not finite 0 times is NaN.
  double sum = 0;
  for (const double value : values) sum += 0 * value;
  if (sum == 0) return central(values);
  const double middle = values[neighbour(0, 0, 0)];
  if (!std::isfinite(middle)) return {};
  Differences slopes;
  for (std::size_t s = 0; s < kDirections; ++s) {
    const auto [i, j, k] = kSteps[s];
    const double ahead = values[neighbour(i, j, k)], behind = values[neighbour(-i, -j, -k)];
    if (std::isfinite(ahead)) {
      slopes[s] =
          std::isfinite(behind) ? (ahead - behind) / (2 * lengths_[s]) : (ahead - middle) / lengths_[s];
    } else if (std::isfinite(behind)) {
      slopes[s] = (middle - behind) / lengths_[s];
    } else {
      slopes[s] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return solve(slopes);
}

Vec3 GradientEstimator::solve(const Differences& slopes) const {
  std::array<Vec3, 3> matrix{};
  Vec3 right;
  for (std::size_t s = 0; s < kDirections; ++s) {
    if (std::isnan(slopes[s])) continue;
    for (int axis = 0; axis < 3; ++axis)
      matrix[static_cast<std::size_t>(axis)] += directions_[s][axis] * directions_[s];
    right += slopes[s] * directions_[s];
  }
  return solve_symmetric(matrix, right);
}

}  // namespace adamas
