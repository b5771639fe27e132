#pragma once

#include <array>
#include <cstddef>

namespace adamas::inline core {

/// Rows of a square matrix of at most five rows; only the first n entries of the first n rows count.
using SmallMatrix = std::array<std::array<double, 5>, 5>;

/// The sign of the determinant of an n x n matrix, n <= 5, with a column of ones and zeros if n is 5: exact
/// for entries of an absolute value of at most 1e300. It is computed in floating point where that is certain,
/// else in whole numbers if the entries are multiples of a number with few bits, else by expansions, sums of
/// numbers that do not overlap (Shewchuk, Adaptive precision floating-point arithmetic, 1997). It is fastest
/// where the last column consists of ones and zeros.
int determinant_sign(SmallMatrix matrix, std::size_t n);

/// The determinant itself, by the same method, with a relative error below 1e-12 however nearly singular the
/// matrix is. It may be beyond the range of a double.
long double determinant_value(SmallMatrix matrix, std::size_t n);

}  // namespace adamas::inline core
