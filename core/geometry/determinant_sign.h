#pragma once

#include <array>
#include <cstddef>

namespace adamas {

/// Rows of a square matrix of at most five rows; the first n of the first n rows count.
using SmallMatrix = std::array<std::array<double, 5>, 5>;

/// The sign of the determinant of an n x n matrix, n <= 5: exact for finite entries whose products neither
/// overflow nor underflow. In floating point where that is certain, else by expansions, sums of doubles that
/// do not overlap (Shewchuk, Adaptive precision floating-point arithmetic, 1997). Fastest where the last
/// column consists of ones and zeros.
int determinant_sign(SmallMatrix matrix, std::size_t n);

/// The determinant itself with a relative error below 1e-12, however nearly singular the matrix is; in the
/// same way.
double determinant_value(SmallMatrix matrix, std::size_t n);

}  // namespace adamas
