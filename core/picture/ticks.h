#pragma once

#include <string>
#include <vector>

namespace adamas::picture {

/// Positions on an axis and their labels; the labels of one axis share a number of decimals or an exponent.
struct Ticks {
  std::vector<double> positions;
  std::vector<std::string> labels;
  std::vector<double> minor;  ///< positions without a label
};

/// About `wanted` ticks at 1, 2 or 5 times a power of ten within [low, high] (the ends included, up to
/// round-off). Needs finite low <= high; equal ends give one tick.
Ticks linear_ticks(double low, double high, int wanted);

/// Ticks at powers of ten within [low, high], 0 < low <= high, thinned to about `wanted`; if fewer than three
/// powers fit, also at 2 and 5 times them. Minor ticks are at the other whole multiples.
Ticks log_ticks(double low, double high, int wanted);

/// A number in as few characters as six significant digits allow, with a true minus sign and powers as "2 x
/// 10^-5" in Unicode; "0.001" to "99999" have no power.
std::string tidy_number(double value);

}  // namespace adamas::picture
