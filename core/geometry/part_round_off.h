#pragma once

#include <algorithm>
#include <cmath>

#include "core/geometry/ownership_problem.h"

namespace adamas::inline core {

/// The greatest absolute value of a problem's functions.
inline double greatest_size(const OwnershipProblem& problem) {
  double size = 0;
  for (const LinearFunction& f : problem.functions) {
    for (const double value : f.values) size = std::max(size, std::abs(value));
  }
  return size;
}

/// A difference below this part of the greatest value may be round-off of a part's corners.
constexpr double kPartRoundOff = 1e-10;

}  // namespace adamas::inline core
