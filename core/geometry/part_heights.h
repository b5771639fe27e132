#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/geometry/divider.h"

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

/// The owner's values at the corners of a part: the least of some functions there.
inline void find_heights(const OwnershipProblem& problem, const std::vector<Weights>& corners,
                         const std::vector<std::uint32_t>& functions, std::vector<double>& heights) {
  heights.assign(corners.size(), std::numeric_limits<double>::infinity());
  for (std::size_t c = 0; c < corners.size(); ++c) {
    for (const std::uint32_t f : functions)
      heights[c] = std::min(heights[c], evaluate(problem.functions[f].values, corners[c]));
  }
}

/// Whether f is less than g, or greater by at most `margin`, at a corner of a part.
inline bool may_be_less(const OwnershipProblem& problem, std::uint32_t f, std::uint32_t g,
                        const std::vector<Weights>& corners, double margin) {
  const auto &x = problem.functions[f].values, &y = problem.functions[g].values;
  return std::ranges::any_of(corners,
                             [&](const Weights& w) { return evaluate(x, w) <= evaluate(y, w) + margin; });
}

/// Whether a candidate is below the heights at all corners of a part by more than `margin`. `hint`: which of
/// its functions is tried first; set to the one that is below.
inline bool is_clearly_below(const OwnershipProblem& problem, const OwnershipProblem::Candidate& candidate,
                             const std::vector<Weights>& corners, const std::vector<double>& heights,
                             double margin, std::uint32_t& hint) {
  const auto is_below = [&](std::uint32_t i) {
    const auto& values = problem.functions[candidate.first + i].values;
    for (std::size_t c = 0; c < corners.size(); ++c) {
      if (!(evaluate(values, corners[c]) + margin < heights[c])) return false;
    }
    return true;
  };
  if (is_below(hint)) return true;
  for (std::uint32_t i = 0; i < candidate.count; ++i) {
    if (!is_below(i)) continue;
    hint = i;
    return true;
  }
  return false;
}

}  // namespace adamas::inline core
