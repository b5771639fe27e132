#include "interfaces/resampling/certification.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace adamas::interfaces {

namespace {

/// The greatest number of rounds of measuring and refining. Usually two or three are enough, unless something
/// cannot be mended.
constexpr int kMostRounds = 20;
/// Rounds for bodies end after this many without an improvement.
constexpr int kMostPatience = 3;
/// If the mesh has become this many times larger since interfaces were first moved to conserve volumes,
/// shifts are reduced instead of splitting cells.
constexpr std::size_t kMostGrowth = 3;
/// Torn bodies are mended by moves before cells are split for them if that leaves at most one fault out of
/// kMendedPart; in the end one out of kMendedPartAtEnd may be left.
constexpr std::size_t kMendedPart = 6, kMendedPartAtEnd = 2;

}  // namespace

RefinementEnd Certification::run() {
  const RefinementEnd reason = measure_and_refine();
  refinement_.record_in(nullptr);
  shown_.clear();
  return reason;
}

RefinementEnd Certification::measure_and_refine() {
  const InterfaceComparison& comparison = shown_.comparison();
  BodyRounds bodies;
  std::size_t first_moved = 0;  // the number of leaves when interfaces were first moved
  bool extracted = false;       // whether the interfaces that the leaves show are extracted
  for (int round = 0;; ++round) {
    if (!std::exchange(extracted, false)) shown_.extract();
    shown_.measure_extracted();
    bodies.best_is_measured = false;
    bodies.best_shown.reset();
    if (state_.conserves && first_moved == 0) first_moved = state_.hierarchy.leaf_count();
    const bool grown = state_.conserves && state_.hierarchy.leaf_count() > kMostGrowth * first_moved;
    std::vector<TetrahedronId> failing;
    if (comparison.within()) {
      if (!grown) failing = conservation_.leaves_of_unconserved_bodies();
    } else if (state_.budget_spent && !state_.options.conserve) {
      return end(RefinementEnd::kBudget, bodies);
    } else {
      failing = shown_.failing_leaves();
    }
    const bool settled = failing.empty();
    if ((settled || grown) && !comparison.within() && round < kMostRounds &&
        conservation_.allow_smaller_shifts(shown_.extracted(), comparison))
      continue;
    if (settled && round < kMostRounds && volumes_.refine()) continue;
    if (settled && !compare_bodies(bodies)) return end(RefinementEnd::kSmallestCells, bodies);
    if (state_.budget_spent) return end(RefinementEnd::kBudget, bodies);
    if (round >= kMostRounds) return end(RefinementEnd::kRounds, bodies);
    if (settled) {
      if (const auto reason = split_for_bodies(bodies)) return end(*reason, bodies);
      extracted = true;
    } else {
      std::vector<TetrahedronId> created = refinement_.split_failing(std::move(failing));
      if (created.empty())
        return end(state_.budget_spent ? RefinementEnd::kBudget : RefinementEnd::kDepth, bodies);
      refinement_.refine_to_targets(std::move(created));
    }
  }
}

/// Compares the bodies shown with the best ones so far, after torn ones are mended; returns whether
/// refinement should continue.
bool Certification::compare_bodies(BodyRounds& bodies) {
  state_.report("comparing bodies");
  mending_.measure();
  // This is done only once before splitting: two moves by half of the error would leave cells that are never
  // within the target.
  if (!bodies.mended) bodies.mended = mending_.move_interfaces(kMendedPart);
  const ShownBodies now = mending_.shown_bodies();
  if (!bodies.best || now.are_better_than(*bodies.best)) {
    bodies.best = now;
    bodies.since_best = {};
    bodies.rounds_since_best = 0;
    bodies.best_is_measured = true;
    return true;
  }
  return ++bodies.rounds_since_best < kMostPatience && now.leaves <= bodies.best->most_leaves();
}

/// Splits cells until the mesh shows better bodies than the best ones so far; distances are not measured
/// before. Returns a reason to end if it does not.
std::optional<RefinementEnd> Certification::split_for_bodies(BodyRounds& bodies) {
  refinement_.record_in(&bodies.since_best);
  while (true) {
    if (const auto reason = mending_.split_cells(*bodies.best)) return reason;
    BodyMending::Shown before = mending_.extract_and_measure();
    if (bodies.best_is_measured && !bodies.best_shown) bodies.best_shown = std::move(before);
    const ShownBodies now = mending_.shown_bodies();
    if (now.are_better_than(*bodies.best)) return {};
    if (state_.budget_spent) return RefinementEnd::kBudget;
    if (++bodies.rounds_since_best >= kMostPatience || now.leaves > bodies.best->most_leaves())
      return RefinementEnd::kSmallestCells;
  }
}

/// Returns to the best bodies and makes their certificate.
RefinementEnd Certification::end(RefinementEnd reason, BodyRounds& bodies) {
  if (!bodies.since_best.splits.empty()) {
    refinement_.undo_splits(bodies.since_best);
    state_.budget_spent = false;
    // Where interfaces were moved for volumes, they were so for the splits that are gone.
    if (!bodies.best_is_measured || (state_.conserves && bodies.best_shown)) {
      shown_.measure();
    } else if (bodies.best_shown) {
      mending_.go_back(std::move(*bodies.best_shown));
    }
  }
  if (state_.options.conserve && !state_.conserves) {
    state_.conserves = true;
    shown_.measure();
  }
  mending_.measure();
  mending_.move_interfaces(kMendedPartAtEnd);
  certificate_ = shown_.finish();
  state_.displacement = std::max(state_.options.interface_error, certificate_.materials.upper);
  return shown_.comparison().within() ? RefinementEnd::kReached : reason;
}

}  // namespace adamas::interfaces
