#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/geometry/convex_polyhedron.h"
#include "core/geometry/divider.h"
#include "core/geometry/ownership_problem.h"
#include "core/geometry/part_round_off.h"
#include "core/geometry/touching_pairs.h"

namespace adamas::inline core {

namespace {

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

/// Gathers touching pairs part by part.
class PairCollector {
 public:
  void start(const OwnershipProblem& problem) {
    const std::size_t count = problem.functions.size();
    if (partners_.size() < count) partners_.resize(count);
    for (std::size_t f = 0; f < count; ++f) partners_[f].clear();
    found_ = {};
  }
  /// Adds a function that may be the least of its candidate in the part.
  void add_near(const NearFunction& near) { found_.near.push_back(near); }
  /// Ends a part of candidate `own`. may_be_equal(f, g) tells whether two functions may be so in it.
  template <class MayBeEqual>
  void end_part(std::uint32_t own, const MayBeEqual& may_be_equal) {
    const auto part = static_cast<std::uint32_t>(found_.ends.size());
    const std::size_t begin = part == 0 ? 0 : found_.ends.back(), known = found_.pairs.size();
    for (std::size_t i = begin; i < found_.near.size(); ++i) {
      if (found_.near[i].candidate == own) continue;
      for (std::size_t k = begin; k < found_.near.size(); ++k) {
        if (found_.near[k].candidate == own) add_pair(found_.near[k], found_.near[i], part, may_be_equal);
      }
    }
    if (found_.pairs.size() == known) {
      found_.near.resize(begin);
      return;
    }
    std::ranges::sort(found_.pairs.begin() + static_cast<std::ptrdiff_t>(known), found_.pairs.end(), {},
                      &TouchingPairs::Pair::pair);
    found_.ends.push_back(static_cast<std::uint32_t>(found_.near.size()));
  }
  [[nodiscard]] TouchingPairs take() { return std::exchange(found_, {}); }

 private:
  template <class MayBeEqual>
  void add_pair(const NearFunction& x, const NearFunction& y, std::uint32_t part,
                const MayBeEqual& may_be_equal) {
    const auto& [first, second] = x.candidate < y.candidate ? std::tie(x, y) : std::tie(y, x);
    std::vector<std::uint32_t>& partners = partners_[first.function];
    if (std::ranges::find(partners, second.function) != partners.end()) return;
    if (!may_be_equal(first.function, second.function)) return;
    partners.push_back(second.function);
    found_.pairs.push_back({{{first.candidate, second.candidate}, {first.function, second.function}}, part});
  }

  TouchingPairs found_;
  /// By function: those with which it is in a pair as the first one.
  std::vector<std::vector<std::uint32_t>> partners_;
};

constexpr std::uint32_t kNone = 0xffffffffu;

/// Gives candidates and functions their new numbers; functions whose number is `kNone` go.
void renumber(const std::vector<std::uint32_t>& candidates, const std::vector<std::uint32_t>& functions,
              TouchingPairs& touching) {
  std::uint32_t begin = 0, kept = 0;
  for (std::uint32_t& end : touching.ends) {
    for (; begin < end; ++begin) {
      const NearFunction near = touching.near[begin];
      if (functions[near.function] != kNone)
        touching.near[kept++] = {candidates[near.candidate], functions[near.function]};
    }
    end = kept;
  }
  touching.near.resize(kept);
  std::erase_if(touching.pairs, [&](const TouchingPairs::Pair& p) {
    return functions[p.pair.functions[0]] == kNone || functions[p.pair.functions[1]] == kNone;
  });
  for (TouchingPairs::Pair& p : touching.pairs) {
    for (std::uint32_t& c : p.pair.candidates) c = candidates[c];
    for (std::uint32_t& f : p.pair.functions) f = functions[f];
  }
}

/// Finds the functions that determine where candidates own or touch something, and the pairs of functions by
/// which they touch, from parts of the tetrahedron that have one owner each. Memory is reused from one
/// problem to the next.
class NeededFunctions {
 public:
  static constexpr bool kHears = true;
  double margin = 0;

  /// `with_pairs`: whether the pairs are wanted.
  void divide(const OwnershipProblem& problem, bool with_pairs) {
    start(problem, with_pairs);
    thread_local Divider<ConvexPolyhedron> divider;
    divider.divide(
        problem, ConvexPolyhedron::unit(),
        [&](std::uint32_t own, const ConvexPolyhedron& part, const std::vector<std::uint32_t>& functions,
            const std::vector<std::uint32_t>& others) { add(own, part.corners(), functions, others); },
        *this);
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
  [[nodiscard]] TouchingPairs take_pairs() { return pairs_.take(); }

 private:
  using Candidate = OwnershipProblem::Candidate;

  void start(const OwnershipProblem& problem, bool with_pairs) {
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
    row_parts_.assign(problem.functions.size(), 0);
    row_places_.resize(problem.functions.size());
    part_number_ = 0;
    with_pairs_ = with_pairs;
    if (with_pairs) pairs_.start(problem);
  }

  /// Adds a part that candidate `own` owns; the least of the functions is its value there. `others`: the
  /// other candidates that may touch it.
  void add(std::uint32_t own, const std::vector<Weights>& corners,
           const std::vector<std::uint32_t>& functions, const std::vector<std::uint32_t>& others) {
    part_corners_ = &corners;
    ++part_number_;
    rows_.clear();
    find_heights(functions);
    const std::uint32_t number = add_piece(corners, part_heights_);
    add_touching(own, functions);
    for (const std::uint32_t c : others) {
      // A candidate that touches a part may own a sliver that round-off has removed.
      if (any_below(c, parts_[number])) {
        add_below(number, c, last_below_[c]);
      } else if (!two_below(c, parts_[number])) {
        all_.resize(problem_->candidates[c].count);
        std::iota(all_.begin(), all_.end(), problem_->candidates[c].first);
        add_touching(c, all_);
      }
    }
    if (!with_pairs_) return;
    pairs_.end_part(own,
                    [&](std::uint32_t f, std::uint32_t g) { return may_be_less(f, g) && may_be_less(g, f); });
  }

  /// Finds the owner's values at the corners of the part: the least of some functions there.
  void find_heights(const std::vector<std::uint32_t>& functions) {
    part_heights_.assign(part_corners_->size(), std::numeric_limits<double>::infinity());
    for (const std::uint32_t f : functions) {
      const std::size_t row = find_row(f);
      for (std::size_t c = 0; c < part_heights_.size(); ++c)
        part_heights_[c] = std::min(part_heights_[c], rows_[row + c]);
    }
  }

  /// Adds that a candidate owns or touches the part, where the least of these functions is its value.
  void add_touching(std::uint32_t c, const std::vector<std::uint32_t>& least) {
    touches_[c] = 1;
    const Candidate& candidate = problem_->candidates[c];
    for (std::uint32_t f = candidate.first; f < candidate.first + candidate.count; ++f) {
      if (needed_[f] != 0 && !with_pairs_) continue;
      if (!std::ranges::all_of(least, [&](std::uint32_t g) { return may_be_less(f, g); })) continue;
      needed_[f] = 1;
      if (with_pairs_) pairs_.add_near({c, f});
    }
  }

  /// Whether f is less than g in the part, or greater by round-off only, at a corner.
  [[nodiscard]] bool may_be_less(std::uint32_t f, std::uint32_t g) {
    const std::size_t x = find_row(f), y = find_row(g);
    for (std::size_t c = 0; c < part_corners_->size(); ++c) {
      if (rows_[x + c] <= rows_[y + c] + margin) return true;
    }
    return false;
  }

  /// The place in `rows_` of a function's values at the corners of the part.
  std::size_t find_row(std::uint32_t f) {
    if (std::exchange(row_parts_[f], part_number_) != part_number_) {
      row_places_[f] = rows_.size();
      for (const Weights& w : *part_corners_) rows_.push_back(value(f, w));
    }
    return row_places_[f];
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

  const OwnershipProblem* problem_ = nullptr;
  std::vector<Part> parts_;
  std::vector<Weights> corners_;  ///< of all parts
  std::vector<double> heights_;
  std::vector<std::pair<double, double>> ranges_;  ///< the least and greatest value of each function
  std::vector<char> needed_;                       ///< by function
  std::vector<std::uint32_t> last_below_;          ///< by candidate
  std::vector<char> touches_;                      ///< whether a candidate owns or touches something
  std::vector<std::vector<PartAbove>> above_;      ///< by candidate

  // Of the part that is being added:
  const std::vector<Weights>* part_corners_ = nullptr;
  std::size_t part_number_ = 0;
  std::vector<double> part_heights_;
  std::vector<double> rows_;             ///< values of functions at the corners
  std::vector<std::size_t> row_places_;  ///< by function: where its values begin
  std::vector<std::size_t> row_parts_;   ///< by function: for which part they were found last
  std::vector<std::uint32_t> all_;       ///< the functions of a candidate

  bool with_pairs_ = false;
  PairCollector pairs_;
};

/// Replaces a problem by what is needed of it, and returns the pairs.
TouchingPairs keep_needed(OwnershipProblem& problem, NeededFunctions& needed) {
  OwnershipProblem kept;
  std::vector<std::uint32_t> functions, new_candidates(problem.candidates.size(), kNone),
      new_functions(problem.functions.size(), kNone);
  for (std::size_t c = 0; c < problem.candidates.size(); ++c) {
    needed.find(c, functions);
    if (functions.empty()) continue;
    drop_never_least(problem, functions);
    new_candidates[c] = static_cast<std::uint32_t>(kept.candidates.size());
    kept.add_candidate(problem.candidates[c].owner);
    for (const std::uint32_t f : functions) {
      new_functions[f] = static_cast<std::uint32_t>(kept.functions.size());
      kept.add_function(problem.functions[f].values, problem.functions[f].key);
    }
  }
  problem = std::move(kept);
  TouchingPairs pairs = needed.take_pairs();
  renumber(new_candidates, new_functions, pairs);
  return pairs;
}

TouchingPairs keep_owners(OwnershipProblem& problem, bool with_pairs) {
  if (problem.candidates.size() < 3 && problem.functions.size() < 3) return {};
  if (const std::optional<TwoOwners> two = two_owners(problem)) {
    const LinearFunction f = problem.functions[two->first->first], g = problem.functions[two->second->first];
    const std::array<std::uint32_t, 2> owners{two->first->owner, two->second->owner};
    problem.clear();
    problem.add_candidate(owners[0]);
    problem.add_function(f.values, f.key);
    problem.add_candidate(owners[1]);
    problem.add_function(g.values, g.key);
    return {};
  }
  drop_high_functions(problem);
  drop_dominated(problem);
  thread_local NeededFunctions needed;
  needed.divide(problem, with_pairs && problem.functions.size() > kManyFunctions);
  return keep_needed(problem, needed);
}

}  // namespace

void keep_owners(OwnershipProblem& problem) { keep_owners(problem, false); }

TouchingPairs keep_owners_and_pairs(OwnershipProblem& problem) { return keep_owners(problem, true); }

TouchingPairs touching_pairs(const OwnershipProblem& problem) {
  thread_local NeededFunctions needed;
  needed.divide(problem, true);
  return needed.take_pairs();
}

}  // namespace adamas::inline core
