#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/partition.h"

namespace adamas {

/// Value of a linear function at a point.
inline double evaluate(const std::array<double, 4>& values, const Weights& w) {
  return values[0] * w[0] + values[1] * w[1] + values[2] * w[2] + values[3] * w[3];
}

/// What may still own a part of a piece: candidates, each with the functions that may still be its least.
struct Contender {
  std::uint32_t owner;
  std::vector<std::uint32_t> functions;
};

/// Every candidate with all its functions.
inline std::vector<Contender> all_contenders(const OwnershipProblem& problem) {
  std::vector<Contender> contenders;
  for (const auto& candidate : problem.candidates) {
    contenders.push_back({candidate.owner, {}});
    for (std::uint32_t f = 0; f < candidate.count; ++f)
      contenders.back().functions.push_back(candidate.first + f);
  }
  return contenders;
}

}  // namespace adamas
