#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/base/simd.h"

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
/// series: the probability to 2e-15, the density to 3e-12 of itself.
class NormalTable {
 public:
  static const NormalTable& instance();

  [[nodiscard]] NormalValue at(double x) const {
    if (!(std::abs(x) < kEnd)) return {x > 0 ? 1.0 : 0.0, 0};
    constexpr std::size_t kBytes = 2 * sizeof(double);
    const auto [probability, density] = at_lanes<kBytes>(Simd<double, kBytes>::Numbers{x, x});
    return {probability[0], density[0]};
  }

  /// Returns the values at two numbers.
  [[nodiscard]] std::array<NormalValue, 2> at_both(double x, double y) const {
    if (!(std::abs(x) < kEnd) || !(std::abs(y) < kEnd)) return {at(x), at(y)};
    constexpr std::size_t kBytes = 2 * sizeof(double);
    const auto [probability, density] = at_lanes<kBytes>(Simd<double, kBytes>::Numbers{x, y});
    return {NormalValue{probability[0], density[0]}, NormalValue{probability[1], density[1]}};
  }

  template <std::size_t Bytes>
  struct Lanes {
    typename Simd<double, Bytes>::Numbers probability, density;
  };
  /// Finds the values at several numbers. Those beyond the ends of the table are moved there, where the
  /// probability is 0 or 1 to round-off.
  template <std::size_t Bytes>
  [[nodiscard, gnu::always_inline]] inline Lanes<Bytes> at_lanes(
      typename Simd<double, Bytes>::Numbers x) const {
    using Vector = Simd<double, Bytes>;
    using Numbers = typename Vector::Numbers;
    constexpr double kLast = kEnd - 1.0 / kPerUnit;
    // A lane that is no number becomes kLast: of two numbers the first one is taken then.
    x = Vector::greater(Vector::lesser(Numbers{} + kLast, x), Numbers{} - kLast);
    const Numbers shifted = x * kPerUnit + (kMiddle + 0.5);
    Numbers a, probability, density;
    for (std::size_t n = 0; n < Vector::kCount; ++n) {
      const auto place = static_cast<int>(shifted[n]);
      const NormalValue& near = nodes_[static_cast<std::size_t>(place)];
      a[n] = (place - kMiddle) / kPerUnit;
      probability[n] = near.probability;
      density[n] = near.density;
    }
    // The derivatives of the density are its products with the polynomials of Hermite.
    const Numbers d = x - a, a2 = a * a, third = a2 - 1, fourth = a * (3 - a2), fifth = a2 * (a2 - 6) + 3,
                  sixth = -a * (a2 * (a2 - 10) + 15);
    const Numbers series =
        1 + d * (-0.5 * a +
                 d * (third * (1.0 / 6) +
                      d * (fourth * (1.0 / 24) + d * (fifth * (1.0 / 120) + d * (sixth * (1.0 / 720))))));
    const Numbers u = -d * (a + 0.5 * d);
    const Numbers change =
        1 + u * (1 + u * (1.0 / 2 + u * (1.0 / 6 + u * (1.0 / 24 + u * (1.0 / 120 + u * (1.0 / 720))))));
    return {probability + density * d * series, density * change};
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

/// Returns the inverse of normal_probability() for p in (0, 1): exact to some units in the last place from
/// 1e-3 to 1 - 1e-3, and elsewhere to 1e-12.
double normal_quantile(double p);

}  // namespace adamas::interfaces
