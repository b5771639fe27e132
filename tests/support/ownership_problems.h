#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/geometry/ownership_problem.h"

namespace adamas::test {

/// What makes a random ownership problem hard.
struct ProblemTraits {
  bool zeros = false;       ///< every third value is zero: exact ties at vertices, along edges and on faces
  bool duplicates = false;  ///< some functions have the values of another, under a key of their own
};

/// Returns a problem of 2 to 6 candidates with 1 to 5 functions each; all keys are different and in no order.
OwnershipProblem random_problem(std::mt19937_64& random, const ProblemTraits& traits);

/// Returns the same problem with candidates, and the functions of each, in another order.
OwnershipProblem shuffled(const OwnershipProblem& problem, std::mt19937_64& random);

/// Returns a random point, uniform in the tetrahedron.
Weights random_weights(std::mt19937_64& random);

/// Returns the least function of a candidate, by brute force.
double candidate_value(const OwnershipProblem& problem, std::size_t candidate, const Weights& weights);

/// The candidate with the greatest least function, where of two equal functions the one with the smaller key
/// counts as greater; and whether this is certain: all others are exactly as great, or lower by more than
/// `margin`.
struct BruteOwner {
  std::uint32_t owner;
  double value;
  bool certain;
};
BruteOwner brute_owner(const OwnershipProblem& problem, const Weights& weights, double margin);

/// A change of owner along a line, at from + t (to - from).
struct OwnerChange {
  double t;
  std::uint32_t before, after;
};

/// Returns all changes along the line from one point to another; each place where two functions are equal is
/// tried. `crowded` is set where two places are too close to tell apart.
std::vector<OwnerChange> owner_changes(const OwnershipProblem& problem, const Weights& from,
                                       const Weights& to, bool& crowded);

}  // namespace adamas::test
