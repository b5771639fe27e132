#include "core/geometry/contact_pairs.h"

#include <algorithm>

#include "core/base/sort_unique.h"
#include "core/geometry/convex_polyhedron.h"
#include "core/geometry/part_heights.h"

namespace adamas::inline core {

namespace {

class PairSearch {
 public:
  explicit PairSearch(const OwnershipProblem& problem)
      : problem_(problem), margin_(kPartRoundOff * greatest_size(problem)) {}

  std::vector<ContactPair> run() {
    thread_local Divider<ConvexPolyhedron> divider;
    divider.divide(problem_, ConvexPolyhedron::unit(),
                   [&](std::uint32_t owner, const ConvexPolyhedron& part,
                       const std::vector<std::uint32_t>& functions) { look_at(owner, part, functions); });
    sort_unique(pairs_);
    return std::move(pairs_);
  }

 private:
  using Candidate = OwnershipProblem::Candidate;

  void look_at(std::uint32_t owner, const ConvexPolyhedron& part,
               const std::vector<std::uint32_t>& functions) {
    const std::vector<Weights>& corners = part.corners();
    find_heights(problem_, corners, functions, heights_);
    const auto& candidates = problem_.candidates;
    for (std::uint32_t a = 0; a < candidates.size(); ++a) {
      if (candidates[a].owner == owner) find_least(candidates[a], corners, functions), own_ = a;
    }
    for (std::uint32_t b = 0; b < candidates.size(); ++b) {
      if (b == own_ || is_clearly_below(problem_, candidates[b], corners, heights_, margin_)) continue;
      for (std::uint32_t g = candidates[b].first; g < candidates[b].first + candidates[b].count; ++g) {
        for (const std::uint32_t f : least_) {
          if (!may_be_less(g, f, corners) || !may_be_less(f, g, corners)) continue;
          pairs_.push_back(own_ < b ? ContactPair{{own_, b}, {f, g}} : ContactPair{{b, own_}, {g, f}});
        }
      }
    }
  }

  /// The owner's functions that may be its least in the part.
  void find_least(const Candidate& candidate, const std::vector<Weights>& corners,
                  const std::vector<std::uint32_t>& functions) {
    least_.clear();
    for (std::uint32_t f = candidate.first; f < candidate.first + candidate.count; ++f) {
      if (std::ranges::all_of(functions, [&](std::uint32_t k) { return may_be_less(f, k, corners); }))
        least_.push_back(f);
    }
  }

  /// Whether f is less than g, or greater by round-off only, at a corner.
  [[nodiscard]] bool may_be_less(std::uint32_t f, std::uint32_t g,
                                 const std::vector<Weights>& corners) const {
    const auto &x = problem_.functions[f].values, &y = problem_.functions[g].values;
    return std::ranges::any_of(corners,
                               [&](const Weights& w) { return evaluate(x, w) <= evaluate(y, w) + margin_; });
  }

  const OwnershipProblem& problem_;
  double margin_;
  std::vector<double> heights_;
  std::uint32_t own_ = 0;
  std::vector<std::uint32_t> least_;
  std::vector<ContactPair> pairs_;
};

}  // namespace

std::vector<ContactPair> contact_pairs(const OwnershipProblem& problem) { return PairSearch(problem).run(); }

}  // namespace adamas::inline core
