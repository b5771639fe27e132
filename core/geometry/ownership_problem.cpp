#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/contenders.h"
#include "core/geometry/partition.h"

namespace adamas {

double OwnershipProblem::value(const Candidate& candidate, const Weights& weights) const {
  double least = evaluate(functions[candidate.first].values, weights);
  for (std::uint32_t f = 1; f < candidate.count; ++f) {
    least = std::min(least, evaluate(functions[candidate.first + f].values, weights));
  }
  return least;
}

std::uint32_t OwnershipProblem::owner(const Weights& weights) const {
  const auto binding = [&](const Candidate& candidate) {
    std::uint32_t best = candidate.first;
    double least = evaluate(functions[best].values, weights);
    for (std::uint32_t f = candidate.first + 1; f < candidate.first + candidate.count; ++f) {
      const double value_f = evaluate(functions[f].values, weights);
      if (value_f < least || (value_f == least && functions[f].key > functions[best].key))
        best = f, least = value_f;
    }
    return std::pair(least, functions[best].key);
  };
  std::uint32_t owner = candidates.front().owner;
  auto [greatest, key] = binding(candidates.front());
  for (std::size_t c = 1; c < candidates.size(); ++c) {
    const auto [value_c, key_c] = binding(candidates[c]);
    if (value_c > greatest || (value_c == greatest && key_c < key)) {
      greatest = value_c, key = key_c, owner = candidates[c].owner;
    }
  }
  return owner;
}

void drop_hopeless(OwnershipProblem& problem) {
  const auto least_at = [&](const OwnershipProblem::Candidate& candidate, std::size_t corner) {
    double least = problem.functions[candidate.first].values[corner];
    for (std::uint32_t f = 1; f < candidate.count; ++f) {
      least = std::min(least, problem.functions[candidate.first + f].values[corner]);
    }
    return least;
  };
  if (problem.candidates.size() < 3) return;
  // Each candidate is concave: nowhere below the least of its corner values, nowhere above the greatest
  // corner value of any of its functions.
  double surely = -std::numeric_limits<double>::infinity();
  for (const auto& candidate : problem.candidates) {
    surely = std::max(surely, std::min({least_at(candidate, 0), least_at(candidate, 1),
                                        least_at(candidate, 2), least_at(candidate, 3)}));
  }
  std::erase_if(problem.candidates, [&](const OwnershipProblem::Candidate& candidate) {
    double at_most = std::numeric_limits<double>::infinity();
    for (std::uint32_t f = 0; f < candidate.count; ++f) {
      const auto& values = problem.functions[candidate.first + f].values;
      at_most = std::min(at_most, *std::max_element(values.begin(), values.end()));
    }
    return at_most < surely;
  });
}

namespace {

/// Whether a contender is below the part's owner by more than `margin` all over the part.
bool is_clearly_below(const OwnershipProblem& problem, const OwnedTetrahedron& part, const Contender& other,
                      const std::array<double, 4>& heights, double margin) {
  return std::any_of(other.functions.begin(), other.functions.end(), [&](std::uint32_t m) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (!(evaluate(problem.functions[m].values, part.corners[c]) + margin < heights[c])) return false;
    }
    return true;
  });
}

/// Drops functions that are at no vertex less than some one other of their contender; of equal ones that with
/// the smaller key counts as greater.
void drop_never_least(const OwnershipProblem& problem, Contender& contender) {
  const std::vector<std::uint32_t> all = contender.functions;
  std::erase_if(contender.functions, [&](std::uint32_t f) {
    const auto& own = problem.functions[f];
    return std::any_of(all.begin(), all.end(), [&](std::uint32_t g) {
      const auto& other = problem.functions[g];
      const bool first = std::pair(other.key, g) > std::pair(own.key, f);
      bool at_most = g != f;
      for (std::size_t v = 0; v < 4; ++v) {
        at_most = at_most && (other.values[v] < own.values[v] || (other.values[v] == own.values[v] && first));
      }
      return at_most;
    });
  });
}

}  // namespace

void keep_owners(OwnershipProblem& problem) {
  if (problem.candidates.size() < 3 && problem.functions.size() < 3) return;
  drop_hopeless(problem);
  std::vector<OwnedTetrahedron> parts;
  partition_tetrahedron(problem, parts);
  std::vector<Contender> contenders = all_contenders(problem);
  double size = 0;
  for (const LinearFunction& f : problem.functions) {
    for (const double value : f.values) size = std::max(size, std::abs(value));
  }
  // The owner's values at the corners of each part.
  std::vector<std::array<double, 4>> heights(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto owner = std::find_if(problem.candidates.begin(), problem.candidates.end(),
                                    [&](const auto& c) { return c.owner == parts[p].owner; });
    for (std::size_t c = 0; c < 4; ++c) heights[p][c] = problem.value(*owner, parts[p].corners[c]);
  }
  // Who touches a part may own a sliver that round-off has taken.
  const auto touches = [&](const Contender& contender, std::size_t p) {
    return contender.owner == parts[p].owner ||
           !is_clearly_below(problem, parts[p], contender, heights[p], 1e-10 * size);
  };
  OwnershipProblem kept;
  for (const Contender& contender : contenders) {
    bool needs = false;
    for (std::size_t p = 0; p < parts.size() && !needs; ++p) needs = touches(contender, p);
    if (!needs) continue;
    Contender needed = contender;
    drop_never_least(problem, needed);
    kept.add_candidate(needed.owner);
    for (const std::uint32_t f : needed.functions)
      kept.add_function(problem.functions[f].values, problem.functions[f].key);
  }
  problem = std::move(kept);
}

}  // namespace adamas
