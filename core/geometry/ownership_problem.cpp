#include "core/geometry/ownership_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/geometry/convex_polyhedron.h"
#include "core/geometry/divider.h"
#include "core/geometry/part_round_off.h"

namespace adamas::inline core {

void OwnershipProblem::add_function(std::array<double, 4> values, std::uint64_t key) {
  for (double& value : values) {
    if (std::abs(value) < kLeastValue) value = 0;
  }
  functions.push_back({values, key});
  ++candidates.back().count;
}

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

void drop_high_functions(OwnershipProblem& problem) {
  const double margin = kPartRoundOff * greatest_size(problem);
  std::uint32_t kept = 0;
  for (OwnershipProblem::Candidate& candidate : problem.candidates) {
    // The candidate is nowhere above the greatest value of any of its functions.
    double ceiling = std::numeric_limits<double>::infinity();
    for (std::uint32_t f = 0; f < candidate.count; ++f)
      ceiling = std::min(ceiling, std::ranges::max(problem.functions[candidate.first + f].values));
    const std::uint32_t first = kept;
    for (std::uint32_t f = 0; f < candidate.count; ++f) {
      const LinearFunction& function = problem.functions[candidate.first + f];
      if (!(std::ranges::min(function.values) > ceiling + margin)) problem.functions[kept++] = function;
    }
    candidate.first = first;
    candidate.count = kept - first;
  }
  problem.functions.resize(kept);
}

void drop_dominated(OwnershipProblem& problem) {
  const auto least_at = [&](const OwnershipProblem::Candidate& candidate, std::size_t corner) {
    double least = problem.functions[candidate.first].values[corner];
    for (std::uint32_t f = 1; f < candidate.count; ++f) {
      least = std::min(least, problem.functions[candidate.first + f].values[corner]);
    }
    return least;
  };
  if (problem.candidates.size() < 3) return;
  // Each candidate is concave: nowhere below the least of its corner values, and nowhere above the greatest
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

/// Returns the two candidates that are left when dominated ones are dropped, if each has one function only;
/// null if there are not two such candidates.
std::array<const OwnershipProblem::Candidate*, 2> last_two(const OwnershipProblem& problem) {
  double surely = -std::numeric_limits<double>::infinity();
  for (const OwnershipProblem::Candidate& candidate : problem.candidates) {
    if (candidate.count != 1) return {};
    const auto& values = problem.functions[candidate.first].values;
    surely = std::max(surely, std::min({values[0], values[1], values[2], values[3]}));
  }
  std::array<const OwnershipProblem::Candidate*, 2> two{};
  std::size_t count = 0;
  for (const OwnershipProblem::Candidate& candidate : problem.candidates) {
    const auto& values = problem.functions[candidate.first].values;
    if (problem.candidates.size() > 2 && std::max({values[0], values[1], values[2], values[3]}) < surely)
      continue;
    if (count == 2) return {};
    two[count++] = &candidate;
  }
  if (count < 2) return {};
  return two;
}

/// Returns whether each of two functions is greater than the other one at some vertex.
bool cross(const LinearFunction& f, const LinearFunction& g) {
  bool above = false, below = false;
  for (std::size_t v = 0; v < 4; ++v) {
    above = above || f.values[v] > g.values[v];
    below = below || f.values[v] < g.values[v];
  }
  return above && below;
}

}  // namespace

std::optional<TwoOwners> two_owners(const OwnershipProblem& problem) {
  const auto [first, second] = last_two(problem);
  if (first == nullptr || !cross(problem.functions[first->first], problem.functions[second->first]))
    return {};
  return TwoOwners{first, second};
}

namespace {

/// On a convex polygon a linear function changes sign at most twice. Due to round-off it may seem to do so
/// more often: the weakest runs of corners on one side then count as zeros of the other side.
void drop_weak_runs(std::vector<double>& d, std::vector<char>& positive) {
  const std::size_t n = d.size();
  while (true) {
    std::size_t changes = 0, weakest = n, weakest_size = 0;
    double weakest_value = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < n; ++c) {
      if (positive[c] == positive[(c + n - 1) % n]) continue;
      ++changes;
      double greatest = 0;
      std::size_t size = 0;
      for (; size < n && positive[(c + size) % n] == positive[c]; ++size)
        greatest = std::max(greatest, std::abs(d[(c + size) % n]));
      if (greatest < weakest_value) weakest_value = greatest, weakest = c, weakest_size = size;
    }
    if (changes <= 2) return;
    const bool side = positive[weakest] == 0;
    for (std::size_t i = 0; i < weakest_size; ++i) {
      d[(weakest + i) % n] = 0;
      positive[(weakest + i) % n] = side ? 1 : 0;
    }
  }
}

class ConvexPolygon {
 public:
  ConvexPolygon() = default;
  explicit ConvexPolygon(std::vector<Weights> corners) : corners_(std::move(corners)) {}
  [[nodiscard]] const std::vector<Weights>& corners() const { return corners_; }

  /// Cuts where `d`, given at the corners, changes sign.
  void cut(std::vector<double>& d, std::vector<char>& positive, ConvexPolygon& above,
           ConvexPolygon& below) const {
    above.corners_.clear();
    below.corners_.clear();
    drop_weak_runs(d, positive);
    for (std::size_t c = 0; c < corners_.size(); ++c) {
      const std::size_t next = (c + 1) % corners_.size();
      (positive[c] != 0 ? above : below).corners_.push_back(corners_[c]);
      if (positive[c] == positive[next]) continue;
      const Weights w = between(corners_[c], corners_[next], d[c] == 0 ? 0 : d[c] / (d[c] - d[next]));
      above.corners_.push_back(w);
      below.corners_.push_back(w);
    }
  }

 private:
  std::vector<Weights> corners_;
};

}  // namespace

namespace {

void append(std::uint32_t owner, const ConvexPolyhedron& part, std::vector<OwnedTetrahedron>& parts) {
  part.for_each_tetrahedron([&](const std::array<Weights, 4>& corners) {
    parts.push_back({owner, corners});
  });
}

/// Divides the tetrahedron between two candidates with one function each, as a Divider does.
void partition_between(const OwnershipProblem& problem, const OwnershipProblem::Candidate& first,
                       const OwnershipProblem::Candidate& second, std::vector<OwnedTetrahedron>& parts) {
  static const ConvexPolyhedron kWhole = ConvexPolyhedron::unit();
  thread_local ConvexPolyhedron above, below;
  thread_local std::vector<double> d;
  thread_local std::vector<char> positive;
  const LinearFunction *f = &problem.functions[first.first], *g = &problem.functions[second.first];
  const bool swapped = f->values[0] < g->values[0] || (f->values[0] == g->values[0] && g->key < f->key);
  if (swapped) std::swap(f, g);
  const std::uint32_t upper = swapped ? second.owner : first.owner,
                      lower = swapped ? first.owner : second.owner;
  d.resize(4);
  positive.resize(4);
  std::size_t positives = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    d[v] = f->values[v] - g->values[v];
    positive[v] = d[v] > 0 || (d[v] == 0 && f->key < g->key) ? 1 : 0;
    positives += positive[v] != 0 ? 1 : 0;
  }
  if (positives == 4) return append(upper, kWhole, parts);
  kWhole.cut(d, positive, above, below);
  append(upper, above, parts);
  append(lower, below, parts);
}

}  // namespace

void partition_tetrahedron(const OwnershipProblem& problem, std::vector<OwnedTetrahedron>& parts) {
  if (const auto [first, second] = last_two(problem);
      first != nullptr && problem.functions[first->first].key != problem.functions[second->first].key)
    return partition_between(problem, *first, *second, parts);
  thread_local Divider<ConvexPolyhedron> divider;
  divider.divide(
      problem, ConvexPolyhedron::unit(),
      [&](std::uint32_t owner, const ConvexPolyhedron& part, const auto&) { append(owner, part, parts); });
}

void partition_polygon(const OwnershipProblem& problem, const std::vector<Weights>& polygon,
                       std::vector<OwnedPolygon>& parts) {
  thread_local Divider<ConvexPolygon> divider;
  divider.divide(problem, ConvexPolygon(polygon),
                 [&](std::uint32_t owner, const ConvexPolygon& part, const auto&) {
                   parts.push_back({owner, part.corners()});
                 });
}

double volume_fraction(const std::array<Weights, 4>& c) {
  // These are edge vectors in the coordinates (w1, w2, w3); the unit tetrahedron has determinant 1.
  std::array<std::array<double, 3>, 3> m{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t i = 0; i < 3; ++i) m[r][i] = c[r + 1][i + 1] - c[0][i + 1];
  }
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

}  // namespace adamas::inline core
