#include "core/geometry/ownership_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/geometry/convex_polyhedron.h"
#include "core/geometry/divider.h"
#include "core/geometry/part_heights.h"

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

/// Drops functions that are at no vertex less than another one of their contender; of two equal ones that
/// with the smaller key counts as greater.
void drop_never_least(const OwnershipProblem& problem, std::vector<std::uint32_t>& functions) {
  const std::vector<std::uint32_t> all = functions;
  std::erase_if(functions, [&](std::uint32_t f) {
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

/// Finds the functions that determine where candidates own or touch something, from parts of the tetrahedron
/// that have one owner each. Memory is reused from one problem to the next.
class NeededFunctions {
 public:
  static constexpr bool kHears = true;
  double margin = 0;

  void start(const OwnershipProblem& problem) {
    problem_ = &problem;
    margin = kPartRoundOff * greatest_size(problem);
    parts_.clear();
    corners_.clear();
    heights_.clear();
    ranges_.clear();
    for (const LinearFunction& f : problem.functions) {
      const auto [least, greatest] = std::ranges::minmax(f.values);
      ranges_.emplace_back(least, greatest);
    }
    needed_.assign(problem.functions.size(), 0);
    const std::size_t count = problem.candidates.size();
    last_below_.resize(count);
    for (std::size_t c = 0; c < count; ++c) last_below_[c] = problem.candidates[c].first;
    touches_.assign(count, 0);
    if (above_.size() < count) above_.resize(count);
    for (std::size_t c = 0; c < count; ++c) above_[c].clear();
  }

  /// Adds a piece where the owners have at least these values at the corners; returns its number.
  std::uint32_t add_piece(const std::vector<Weights>& corners, const std::vector<double>& heights) {
    const auto [lowest, highest] = std::ranges::minmax(heights);
    parts_.push_back({static_cast<std::uint32_t>(corners_.size()), static_cast<std::uint32_t>(corners.size()),
                      lowest, highest});
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    heights_.insert(heights_.end(), heights.begin(), heights.end());
    return static_cast<std::uint32_t>(parts_.size() - 1);
  }
  /// Adds that a candidate has nothing in a piece, since one of its functions is clearly below the owners.
  void add_below(std::uint32_t piece, std::uint32_t candidate, std::uint32_t function) {
    above_[candidate].push_back({piece, function});
  }

  /// Adds a part that candidate `own` owns; the least of the functions is its value there. `others`: the
  /// other candidates that may touch it.
  void add(std::uint32_t own, const std::vector<Weights>& corners,
           const std::vector<std::uint32_t>& functions, const std::vector<std::uint32_t>& others) {
    find_heights(*problem_, corners, functions, part_heights_);
    const std::uint32_t number = add_piece(corners, part_heights_);
    for (const std::uint32_t c : others) {
      // A candidate that touches a part may own a sliver that round-off has removed.
      if (any_below(c, parts_[number])) {
        add_below(number, c, last_below_[c]);
      } else if (!two_below(c, parts_[number])) {
        add_touching(c, corners, nullptr);
      }
    }
    add_touching(own, corners, &functions);
  }

  /// Sets `needed` to the functions of a candidate that determine where it owns or touches something; to none
  /// if it does so nowhere.
  void find(std::size_t c, std::vector<std::uint32_t>& needed) {
    needed.clear();
    if (touches_[c] == 0) return;
    const Candidate& candidate = problem_->candidates[c];
    const std::uint32_t end = candidate.first + candidate.count;
    for (const auto& [number, found_below] : above_[c]) {
      if (needed_[found_below] != 0) continue;
      const Part& part = parts_[number];
      bool known = false;
      for (std::uint32_t f = candidate.first; f < end && !known; ++f)
        known = needed_[f] != 0 && is_below(f, part);
      if (known) continue;
      std::uint32_t first = candidate.first;
      while (!is_below(first, part)) ++first;
      needed_[first] = 1;
    }
    for (std::uint32_t f = candidate.first; f < end; ++f) {
      if (needed_[f] != 0) needed.push_back(f);
    }
  }

 private:
  using Candidate = OwnershipProblem::Candidate;

  /// Adds a part that a candidate touches or, where the least of `own` is its value, owns.
  void add_touching(std::uint32_t c, const std::vector<Weights>& corners,
                    const std::vector<std::uint32_t>* own) {
    touches_[c] = 1;
    const Candidate& candidate = problem_->candidates[c];
    for (std::uint32_t f = candidate.first; f < candidate.first + candidate.count; ++f) {
      if (needed_[f] == 0) needed_[f] = may_be_least(f, candidate, own, corners);
    }
  }

  struct Part {
    std::uint32_t first_corner, corner_count;
    double lowest, highest;  ///< the least of the owner's values at the corners and the greatest one
  };
  /// A part where a candidate has nothing, since one of its functions is clearly below the owner.
  struct PartAbove {
    std::uint32_t part, below;
  };

  [[nodiscard]] double value(std::uint32_t f, const Weights& w) const {
    return evaluate(problem_->functions[f].values, w);
  }

  /// Whether a function is clearly below the owner of a part.
  [[nodiscard]] bool is_below(std::uint32_t f, const Part& part) const {
    const auto& [least, greatest] = ranges_[f];
    if (least >= part.highest) return false;
    if (greatest + 2 * margin < part.lowest) return true;
    for (std::uint32_t c = part.first_corner; c < part.first_corner + part.corner_count; ++c) {
      if (!(value(f, corners_[c]) + margin < heights_[c])) return false;
    }
    return true;
  }

  /// Whether any function of a candidate is. Parts follow their neighbours, where it is often the same one.
  [[nodiscard]] bool any_below(std::size_t c, const Part& part) {
    if (is_below(last_below_[c], part)) return true;
    const Candidate& candidate = problem_->candidates[c];
    for (std::uint32_t f = candidate.first; f < candidate.first + candidate.count; ++f) {
      if (!is_below(f, part)) continue;
      last_below_[c] = f;
      return true;
    }
    return false;
  }

  /// Whether two functions of a candidate are together clearly below the owner of a part: a weighted mean of
  /// the two is below, and the lesser one is nowhere above that. Both are needed then.
  [[nodiscard]] bool two_below(std::size_t c, const Part& part) {
    const Candidate& candidate = problem_->candidates[c];
    const std::uint32_t end = candidate.first + candidate.count;
    for (std::uint32_t k = part.first_corner; k < part.first_corner + part.corner_count; ++k) {
      bool below = false;
      for (std::uint32_t f = candidate.first; f < end && !below; ++f)
        below = value(f, corners_[k]) + margin < heights_[k];
      if (!below) return false;
    }
    for (std::uint32_t f = candidate.first; f < end; ++f) {
      for (std::uint32_t g = f + 1; g < end; ++g) {
        if (!mean_is_below(f, g, part)) continue;
        needed_[f] = needed_[g] = 1;
        return true;
      }
    }
    return false;
  }

  /// Whether a weighted mean of two functions is clearly below the owner of a part.
  [[nodiscard]] bool mean_is_below(std::uint32_t f, std::uint32_t g, const Part& part) const {
    double least = 0, greatest = 1;  // of the weights of f with which it is so at all corners
    for (std::uint32_t k = part.first_corner; k < part.first_corner + part.corner_count; ++k) {
      const double a = value(f, corners_[k]) + margin - heights_[k],
                   b = value(g, corners_[k]) + margin - heights_[k];
      if (a >= 0 && b >= 0) return false;
      if (a >= 0) greatest = std::min(greatest, b / (b - a));
      if (b >= 0) least = std::max(least, b / (b - a));
    }
    return least < greatest;
  }

  /// Whether a function is at most each other one of its candidate somewhere, but for round-off; `others`:
  /// only these count.
  [[nodiscard]] bool may_be_least(std::uint32_t f, const Candidate& candidate,
                                  const std::vector<std::uint32_t>* others,
                                  const std::vector<Weights>& corners) const {
    const auto at_most = [&](std::uint32_t g) { return may_be_less(*problem_, f, g, corners, margin); };
    if (others != nullptr) return std::ranges::all_of(*others, at_most);
    for (std::uint32_t g = candidate.first; g < candidate.first + candidate.count; ++g) {
      if (!at_most(g)) return false;
    }
    return true;
  }

  const OwnershipProblem* problem_ = nullptr;
  std::vector<Part> parts_;
  std::vector<Weights> corners_;  ///< of all parts
  std::vector<double> heights_, part_heights_;
  std::vector<std::pair<double, double>> ranges_;  ///< the least and greatest value of each function
  std::vector<char> needed_;                       ///< by function
  std::vector<std::uint32_t> last_below_;          ///< by candidate
  std::vector<char> touches_;                      ///< whether a candidate owns or touches something
  std::vector<std::vector<PartAbove>> above_;      ///< by candidate
};

}  // namespace

std::optional<TwoOwners> two_owners(const OwnershipProblem& problem) {
  const auto [first, second] = last_two(problem);
  if (first == nullptr || !cross(problem.functions[first->first], problem.functions[second->first]))
    return {};
  return TwoOwners{first, second};
}

void keep_owners(OwnershipProblem& problem) {
  if (problem.candidates.size() < 3 && problem.functions.size() < 3) return;
  if (const std::optional<TwoOwners> two = two_owners(problem)) {
    const LinearFunction f = problem.functions[two->first->first], g = problem.functions[two->second->first];
    const std::array<std::uint32_t, 2> owners{two->first->owner, two->second->owner};
    problem.clear();
    problem.add_candidate(owners[0]);
    problem.add_function(f.values, f.key);
    problem.add_candidate(owners[1]);
    problem.add_function(g.values, g.key);
    return;
  }
  drop_high_functions(problem);
  drop_dominated(problem);
  thread_local NeededFunctions needed;
  needed.start(problem);
  thread_local Divider<ConvexPolyhedron> divider;
  divider.divide(
      problem, ConvexPolyhedron::unit(),
      [&](std::uint32_t own, const ConvexPolyhedron& part, const std::vector<std::uint32_t>& functions,
          const std::vector<std::uint32_t>& others) { needed.add(own, part.corners(), functions, others); },
      needed);
  OwnershipProblem kept;
  std::vector<std::uint32_t> functions;
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    const OwnershipProblem::Candidate& candidate = problem.candidates[c];
    needed.find(c, functions);
    if (functions.empty()) continue;
    drop_never_least(problem, functions);
    kept.add_candidate(candidate.owner);
    for (const std::uint32_t f : functions)
      kept.add_function(problem.functions[f].values, problem.functions[f].key);
  }
  problem = std::move(kept);
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
