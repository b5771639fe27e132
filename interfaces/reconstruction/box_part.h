#pragma once

#include <array>

namespace adamas {

/// The part of a box of sides m round the origin where x + y + z <= s, for m in ascending order: Scardovelli
/// and Zaleski, 2000.
inline double part_below(const std::array<double, 3>& m, double s) {
  const double total = m[0] + m[1] + m[2], alpha = s + 0.5 * total;
  if (alpha <= 0) return 0;
  if (alpha >= total) return 1;
  // From the nearer corner, where nothing cancels.
  if (alpha > 0.5 * total) return 1 - part_below(m, -s);
  if (m[1] <= 1e-9 * m[2]) return alpha / m[2];
  if (m[0] <= 1e-6 * m[2]) {
    const double a = alpha;
    const double area = a < m[1] ? a * a / 2 : m[1] * (a - m[1] / 2);
    return area / (m[1] * m[2]);
  }
  const auto cube = [](double x) { return x > 0 ? x * x * x : 0; };
  return (cube(alpha) - cube(alpha - m[0]) - cube(alpha - m[1]) - cube(alpha - m[2]) +
          cube(alpha - m[0] - m[1])) /
         (6 * m[0] * m[1] * m[2]);
}

}  // namespace adamas
