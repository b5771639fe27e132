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
inline double normal_quantile(double p) {
  // The quantile is computed from the nearer tail, where nothing cancels, by a rational function (Abramowitz
  // and Stegun, Handbook of Mathematical Functions, 26.2.23), and two steps of Halley's method.
  if (p > 0.5) return -normal_quantile(1 - p);
  const double t = std::sqrt(-2 * std::log(p));
  double x =
      (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  for (int step = 0; step < 2; ++step) {
    const double by = (normal_probability(x) - p) / normal_density(x);
    x -= by / (1 + 0.5 * x * by);
  }
  return x;
}

}  // namespace adamas::interfaces
