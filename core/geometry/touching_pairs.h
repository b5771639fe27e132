#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/ownership_problem.h"

namespace adamas::inline core {

/// With more functions than this, contact polygons are not sought by trying all pairs.
constexpr std::size_t kManyFunctions = 64;

/// Two candidates by their places, the first one first, and one function of each.
struct ContactPair {
  std::array<std::uint32_t, 2> candidates, functions;
  auto operator<=>(const ContactPair&) const = default;
};

/// A function and its candidate.
struct NearFunction {
  std::uint32_t candidate, function;
};

/// Pairs of functions that may be equal, each the least of its candidate, where two candidates touch; and the
/// functions near that place, which bound what is left of the pair. With many candidates these are few of all
/// pairs: the pairs that are equal, but for round-off, in a part of one owner which the other may touch.
struct TouchingPairs {
  struct Pair {
    ContactPair pair;
    std::uint32_t part;
  };
  std::vector<Pair> pairs;  ///< each pair once, ascending by part and pair
  std::vector<NearFunction> near;
  std::vector<std::uint32_t> ends;  ///< by part: the end of the functions in `near` that are near it
  [[nodiscard]] std::span<const NearFunction> near_part(std::size_t part) const {
    const std::uint32_t begin = part == 0 ? 0 : ends[part - 1];
    return std::span(near).subspan(begin, ends[part] - begin);
  }
};

/// Finds the pairs by dividing the tetrahedron.
TouchingPairs touching_pairs(const OwnershipProblem& problem);

/// Does what keep_owners() does, and returns the pairs of what is left, if that has many functions: they come
/// from the same division of the tetrahedron.
TouchingPairs keep_owners_and_pairs(OwnershipProblem& problem);

}  // namespace adamas::inline core
