#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace adamas::interfaces {

/// The standard deviation of a number that is uniformly distributed in an interval of length 1: the width of
/// the step of a sharp interface's fractions, in cells.
inline constexpr double kUniformDeviation = 0.288675;

/// The normal distribution of mean 0 and variance 1: the probability that a number is below some x, and the
/// density there.
struct NormalValue {
  double probability, density;
};

/// Values of the normal distribution at evenly spaced numbers, from which those at others are found by Taylor
/// series: the probability to 1e-15, the density to 2e-12 of itself.
class NormalTable {
 public:
  static const NormalTable& instance();

  [[nodiscard]] NormalValue at(double x) const {
    if (!(std::abs(x) < kEnd)) return {x > 0 ? 1.0 : 0.0, 0};
    const auto place = static_cast<int>(x * kPerUnit + (kMiddle + 0.5));
    const double a = (place - kMiddle) / kPerUnit, d = x - a;
    const NormalValue& near = nodes_[static_cast<std::size_t>(place)];
    // The derivatives of the density are its products with the polynomials of Hermite.
    const double a2 = a * a, third = a2 - 1, fourth = a * (3 - a2), fifth = a2 * (a2 - 6) + 3,
                 sixth = -a * (a2 * (a2 - 10) + 15);
    const double series =
        1 + d * (-a / 2 +
                 d * (third / 6 + d * (fourth / 24 + d * (fifth / 120 + d * (sixth / 720)))));
    const double u = -d * (a + 0.5 * d);
    const double change =
        1 + u * (1 + u * (1.0 / 2 + u * (1.0 / 6 + u * (1.0 / 24 + u * (1.0 / 120 + u * (1.0 / 720))))));
    return {near.probability + near.density * d * series, near.density * change};
  }

 private:
  NormalTable();

  static constexpr double kEnd = 8.5, kPerUnit = 64, kMiddle = kEnd * kPerUnit;
  std::array<NormalValue, static_cast<std::size_t>(2 * kMiddle) + 1> nodes_{};
};

/// The density of the normal distribution of mean 0 and variance 1.
inline double normal_density(double x) {
  return std::exp(-0.5 * x * x) * (0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2);
}

/// The probability that a number with the normal distribution of mean 0 and variance 1 is below x.
inline double normal_probability(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// Returns the inverse of normal_probability() for p in (0, 1): exact to some units in the last place from 1e-3
/// to 1 - 1e-3, and elsewhere to 1e-12.
double normal_quantile(double p);

}  // namespace adamas::interfaces
