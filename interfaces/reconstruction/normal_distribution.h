#pragma once

#include <cmath>
#include <numbers>

namespace adamas::interfaces {

/// The standard deviation of a number that is uniformly distributed in an interval of length 1: the width of
/// the step of a sharp interface's fractions, in cells.
inline constexpr double kUniformDeviation = 0.288675;

/// The density of the normal distribution of mean 0 and variance 1.
inline double normal_density(double x) {
  return std::exp(-0.5 * x * x) * (0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2);
}

/// The probability that a number with the normal distribution of mean 0 and variance 1 is below x.
inline double normal_probability(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// Returns the inverse of normal_probability() for p in (0, 1), exact to some units in the last place.
double normal_quantile(double p);

}  // namespace adamas::interfaces
