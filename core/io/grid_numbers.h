#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/io/grid_file.h"

namespace adamas::io {

/// Whether a float represents a number exactly; NaN counts as represented.
inline bool float_has(double number) {
  return std::isnan(number) || static_cast<double>(static_cast<float>(number)) == number;
}

/// Whether a number is a whole one that the type Whole holds.
template <class Whole, class Number>
bool is_whole(Number number) {
  if constexpr (std::is_floating_point_v<Number>) {
    constexpr Number kBeyond = static_cast<Number>(std::uint64_t{1} << 63);
    static_assert(std::is_same_v<Whole, std::int64_t>);
    return number == std::floor(number) && number >= -kBeyond && number < kBeyond;
  } else if constexpr (sizeof(Number) < sizeof(std::int32_t)) {
    return std::is_signed_v<Whole> || number >= 0;
  } else {
    return std::in_range<Whole>(number);
  }
}

/// Whether numbers are to be kept as Whole: all of them are whole and fit and, if they are doubles, floats
/// would not represent all of them. `for_each` is as in set_numbers.
template <class Whole, class Number, class ForEach>
bool are_whole(const ForEach& for_each) {
  bool whole = true, need = !std::is_floating_point_v<Number>;
  for_each([&](Number number) {
    whole = is_whole<Whole>(number);
    if constexpr (std::is_same_v<Number, double>) need = need || !float_has(number);
    return whole;
  });
  return whole && need;
}

/// Whether floats represent all of the numbers.
template <class ForEach>
bool are_floats(const ForEach& for_each) {
  bool floats = true;
  for_each([&floats](double number) {
    floats = float_has(number);
    return floats;
  });
  return floats;
}

/// Sets the `count` numbers of an array in the first type that fits them. `for_each(take)` calls `take` with
/// one number after another until it returns false.
template <class Number, class ForEach>
void set_numbers(const ForEach& for_each, std::size_t count, GridArray& array) {
  const auto set = [&]<class Kept>(Kept) {
    std::vector<Kept> kept;
    kept.reserve(count);
    for_each([&kept](Number number) {
      kept.push_back(static_cast<Kept>(number));
      return true;
    });
    array.values = std::move(kept);
  };
  if constexpr (std::is_integral_v<Number>) {
    if (are_whole<std::int32_t, Number>(for_each)) return set(std::int32_t{});
    if (are_whole<std::int64_t, Number>(for_each)) return set(std::int64_t{});
    return set(std::uint64_t{});
  } else if constexpr (std::is_same_v<Number, double>) {
    if (are_whole<std::int64_t, Number>(for_each)) return set(std::int64_t{});
    if (!are_floats(for_each)) return set(double{});
  }
  set(float{});
}

/// Sets the numbers of an array from numbers in memory.
template <class Number>
void set_numbers(std::span<const Number> numbers, GridArray& array) {
  const auto for_each = [numbers](const auto& take) {
    for (const Number number : numbers) {
      if (!take(number)) return;
    }
  };
  set_numbers<Number>(for_each, numbers.size(), array);
}

}  // namespace adamas::io
