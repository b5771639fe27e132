#include "tests/support/ownership_problems.h"

#include <algorithm>
#include <cmath>

namespace adamas::test {

namespace {

double at(const LinearFunction& f, const Weights& w) {
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) sum += f.values[i] * w[i];
  return sum;
}

Weights mixed(const Weights& a, const Weights& b, double t) {
  Weights w;
  for (std::size_t i = 0; i < 4; ++i) w[i] = a[i] + t * (b[i] - a[i]);
  return w;
}

}  // namespace

OwnershipProblem random_problem(std::mt19937_64& random, const ProblemTraits& traits) {
  std::uniform_real_distribution<double> value(-1, 1);
  const auto below = [&](std::uint64_t n) { return random() % n; };
  OwnershipProblem problem;
  const std::size_t candidates = 2 + below(5);
  std::uint64_t key = 1000;
  for (std::size_t c = 0; c < candidates; ++c) {
    problem.add_candidate(static_cast<std::uint32_t>(c * 7 % 11));
    const std::size_t functions = 1 + below(5);
    for (std::size_t f = 0; f < functions; ++f) {
      std::array<double, 4> values{};
      for (double& v : values) v = traits.zeros && below(3) == 0 ? 0 : value(random);
      if (traits.duplicates && !problem.functions.empty() && below(3) == 0)
        values = problem.functions[below(problem.functions.size())].values;
      key += 1 + below(5);
      problem.add_function(values, key);
    }
  }
  std::vector<std::uint64_t> keys;
  for (const auto& f : problem.functions) keys.push_back(f.key);
  std::shuffle(keys.begin(), keys.end(), random);
  for (std::size_t f = 0; f < keys.size(); ++f) problem.functions[f].key = keys[f];
  return problem;
}

OwnershipProblem shuffled(const OwnershipProblem& problem, std::mt19937_64& random) {
  auto candidates = problem.candidates;
  std::shuffle(candidates.begin(), candidates.end(), random);
  OwnershipProblem result;
  for (const auto& candidate : candidates) {
    const auto first = problem.functions.begin() + candidate.first;
    std::vector<LinearFunction> functions(first, first + candidate.count);
    std::shuffle(functions.begin(), functions.end(), random);
    result.add_candidate(candidate.owner);
    for (const auto& f : functions) result.add_function(f.values, f.key);
  }
  return result;
}

Weights random_weights(std::mt19937_64& random) {
  std::exponential_distribution<double> part;
  Weights w;
  double sum = 0;
  for (double& x : w) sum += x = part(random);
  for (double& x : w) x /= sum;
  return w;
}

double candidate_value(const OwnershipProblem& problem, std::size_t candidate, const Weights& weights) {
  const auto& c = problem.candidates[candidate];
  double least = at(problem.functions[c.first], weights);
  for (std::uint32_t f = 1; f < c.count; ++f)
    least = std::min(least, at(problem.functions[c.first + f], weights));
  return least;
}

BruteOwner brute_owner(const OwnershipProblem& problem, const Weights& weights, double margin) {
  // This returns the value and the key of the least function; among equal values a greater key counts as
  // less.
  const auto least = [&](const OwnershipProblem::Candidate& c) {
    std::pair<double, std::uint64_t> best{at(problem.functions[c.first], weights),
                                          problem.functions[c.first].key};
    for (std::uint32_t f = c.first; f < c.first + c.count; ++f) {
      const double value = at(problem.functions[f], weights);
      const std::uint64_t key = problem.functions[f].key;
      if (value < best.first || (value == best.first && key > best.second)) best = {value, key};
    }
    return best;
  };
  std::size_t winner = 0;
  for (std::size_t c = 1; c < problem.candidates.size(); ++c) {
    const auto mine = least(problem.candidates[c]), its = least(problem.candidates[winner]);
    if (mine.first > its.first || (mine.first == its.first && mine.second < its.second)) winner = c;
  }
  const double value = least(problem.candidates[winner]).first;
  bool certain = true;
  for (const auto& candidate : problem.candidates) {
    const double other = least(candidate).first;
    certain = certain && (other == value || other < value - margin);
    for (std::uint32_t f = candidate.first; f < candidate.first + candidate.count; ++f) {
      const double all = at(problem.functions[f], weights);
      certain = certain && (all == value || std::abs(all - value) > margin);
    }
  }
  return {problem.candidates[winner].owner, value, certain};
}

std::vector<OwnerChange> owner_changes(const OwnershipProblem& problem, const Weights& from,
                                       const Weights& to, bool& crowded) {
  std::vector<double> places;
  for (std::size_t f = 0; f < problem.functions.size(); ++f) {
    for (std::size_t g = 0; g < f; ++g) {
      const double a = at(problem.functions[f], from) - at(problem.functions[g], from);
      const double b = at(problem.functions[f], to) - at(problem.functions[g], to);
      if (a != b && a / (a - b) > 0 && a / (a - b) < 1) places.push_back(a / (a - b));
    }
  }
  places.push_back(0);
  places.push_back(1);
  std::sort(places.begin(), places.end());
  std::vector<OwnerChange> changes;
  std::uint32_t before = 0;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const double length = places[i + 1] - places[i];
    if (length < 1e-12) continue;  // the two functions have the same values
    if (length < 1e-6) crowded = true;
    const Weights middle = mixed(from, to, 0.5 * (places[i] + places[i + 1]));
    const std::uint32_t owner = brute_owner(problem, middle, 0).owner;
    if (i > 0 && owner != before) changes.push_back({places[i], before, owner});
    before = owner;
  }
  return changes;
}

}  // namespace adamas::test
