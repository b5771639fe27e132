#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace adamas::inline core {

/// Returns the sum after `count` additions of a number, each of which is rounded, without all of them: as
/// long as sums have one exponent, each addition adds the same. `number` is positive.
inline double add_repeatedly(double sum, double number, std::uint64_t count) {
  constexpr std::uint64_t kFew = 8;
  while (count > kFew) {
    // A sum that lies halfway between two numbers is rounded to the even one, so that only steps behind the
    // second sum are all equal.
    if (sum < 0) {
      sum += number;
      --count;
      continue;
    }
    const double first = sum + number, second = first + number, third = second + number,
                 step = third - second;
    count -= 3;
    sum = third;
    int low = 0, high = 0;
    std::frexp(first, &low);
    std::frexp(third, &high);
    if (low != high) continue;
    if (step == 0) return sum;
    const double room = std::ldexp(1.0, high) - number - sum;
    if (!(room > step)) continue;
    const double most = std::floor(room / step) - 1;
    const std::uint64_t steps = most < static_cast<double>(count) ? static_cast<std::uint64_t>(most) : count;
    sum += static_cast<double>(steps) * step;
    count -= steps;
  }
  for (; count > 0; --count) sum += number;
  return sum;
}

/// Lengths along an axis, of which many that follow each other are equal.
class AxisLengths {
 public:
  explicit AxisLengths(std::vector<double> lengths) : lengths_(std::move(lengths)), ends_(lengths_.size()) {
    for (std::size_t i = lengths_.size(); i-- > 0;)
      ends_[i] = i + 1 < lengths_.size() && lengths_[i + 1] == lengths_[i] ? ends_[i + 1] : i + 1;
  }

  [[nodiscard]] std::size_t size() const { return lengths_.size(); }
  /// Adds value(length), which is positive, for the lengths from `begin` to before `end`, one after another.
  template <class Value>
  [[nodiscard]] double add(double sum, std::size_t begin, std::size_t end, Value&& value) const {
    while (begin < end) {
      const std::size_t stop = ends_[begin] < end ? ends_[begin] : end;
      sum = add_repeatedly(sum, value(lengths_[begin]), stop - begin);
      begin = stop;
    }
    return sum;
  }

 private:
  std::vector<double> lengths_;
  std::vector<std::size_t> ends_;  ///< by length: behind the last of those that follow it and are equal
};

}  // namespace adamas::inline core
