#include "isosurface/gradients/gradient_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adamas::isosurface {

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

/// A pivot below this part of the greatest one is round-off.
constexpr double kSingular = 1e-10;

/// Solves a symmetric system that is positive semidefinite, by elimination with the greatest pivot first.
/// Unknowns that the system does not determine are 0.
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

Vec3 GradientEstimator::operator()(const Neighbourhood& values) const {
  // 0 times a number that is not finite is NaN.
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

}  // namespace adamas::isosurface
