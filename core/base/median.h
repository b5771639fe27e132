#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace adamas::inline core {

/// The standard deviation of normally distributed numbers in relation to the median of their absolute values.
inline constexpr double kDeviationByMedian = 1.4826;

/// The median of at least one number; for an even number of them, the greater of the two in the middle. It
/// changes the order of the numbers.
template <class T>
T median(std::vector<T>& numbers) {
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

}  // namespace adamas::inline core
