#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/geometry/partition.h"

namespace adamas::inline core {

/// Two candidates by their places, the first one first, and a function of each.
struct ContactPair {
  std::array<std::uint32_t, 2> candidates, functions;
  auto operator<=>(const ContactPair&) const = default;
};

/// The pairs of functions that may be equal, each the least of its candidate, where two candidates touch; in
/// ascending order. Of many candidates these are few of all pairs: those that are equal, but for round-off,
/// in a part of one owner, which the other may touch.
std::vector<ContactPair> contact_pairs(const OwnershipProblem& problem);

}  // namespace adamas::inline core
