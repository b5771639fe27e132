#include "interfaces/resampling/certification.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "interfaces/resampling/cell_evaluation.h"

namespace adamas::interfaces {

namespace {

/// The greatest number of rounds of measuring and refining. Usually two or three are enough, unless something
/// cannot be mended.
constexpr int kMostRounds = 20;
/// New leaves are measured alone if they are at most this part of all, and else with all.
constexpr double kNewPart = 0.15;
/// Rounds for bodies end after this many without an improvement.
constexpr int kMostPatience = 3;
/// Torn bodies are mended by moves before cells are split for them if that leaves at most one fault out of
/// kMendedPart; in the end one out of kMendedPartAtEnd may be left.
constexpr std::size_t kMendedPart = 6, kMendedPartAtEnd = 2;
/// The greatest number of times that interfaces are moved farther than is sure to do no harm.
constexpr int kMostTries = 3;
/// If some may not move as far as they would, others move farther, up to this times the greatest distance.
constexpr double kFartherMoves = 2;
/// The part of what interfaces may move by that they do, so that round-off does no harm.
constexpr double kSurely = 1 - 1e-9;
/// The greatest number of times that interfaces are held where moves have done harm, if conservation was
/// asked for, and if not: each takes a measurement.
constexpr int kMostHeld = 4, kMostHeldUnasked = 1;
/// If more than this part of a material's volume is missing, interfaces move where bodies may change by it.
constexpr double kMuchMissing = 1e-4;
/// If distances are greater than wanted before interfaces are moved to conserve volumes, they may become
/// greater by this part if conservation was asked for.
constexpr double kFartherPart = 0.05;

/// Returns whether the mesh shows a body less well than before.
bool is_worse(const BodyReport& now, const BodyReport& before, BodyId body) {
  const auto faults = [body](const BodyReport& report) {
    return std::pair(report.input[body].pieces > 0 && report.mesh[body].pieces == 0, report.torn(body));
  };
  return faults(now) > faults(before);
}

}  // namespace

RefinementEnd Certification::run() {
  end_ = measure_and_refine();
  if (state_.options.conserve) {
    // The certificate follows when interfaces have been moved.
    state_.displacement =
        std::max(state_.options.interface_error, shown_.comparison().greatest_of_materials());
  } else {
    finish();
  }
  return end_;
}

/// Makes the certificate and frees what it was made from.
void Certification::finish() {
  certificate_ = shown_.finish();
  state_.displacement = std::max(state_.options.interface_error, certificate_.materials.upper);
  shown_.clear();
}

RefinementEnd Certification::measure_and_refine() {
  const InterfaceComparison& comparison = shown_.comparison();
  BodyRounds bodies;
  bool extracted = false;  // whether the interfaces that the leaves show are extracted
  for (int round = 0;; ++round) {
    if (!std::exchange(extracted, false)) shown_.extract();
    shown_.measure_extracted();
    bodies.best_is_measured = false;
    bodies.best_shown.reset();
    std::vector<TetrahedronId> failing;
    if (!comparison.within()) {
      if (state_.budget_spent) return end(RefinementEnd::kBudget, bodies);
      failing = shown_.failing_leaves();
    }
    const bool settled = failing.empty();
    if (settled && round < kMostRounds && volumes_.refine()) continue;
    if (settled && !compare_bodies(bodies)) return end(RefinementEnd::kSmallestCells, bodies);
    if (state_.budget_spent) return end(RefinementEnd::kBudget, bodies);
    if (round >= kMostRounds) return end(RefinementEnd::kRounds, bodies);
    if (settled) {
      if (const auto reason = split_for_bodies(bodies)) return end(*reason, bodies);
      extracted = true;
    } else {
      if (!split_failing(std::move(failing)))
        return end(state_.budget_spent ? RefinementEnd::kBudget : RefinementEnd::kDepth, bodies);
    }
  }
}

/// Splits leaves with a fault, and new ones as long as some are found to have one and are few, so that
/// finding them takes far less than measuring all interfaces again. Returns whether any were split.
bool Certification::split_failing(std::vector<TetrahedronId> failing) {
  bool any = false;
  for (int round = 0; round < kMostRounds && !failing.empty(); ++round) {
    std::vector<TetrahedronId> leaves;
    refinement_.set_observer([&](const auto& /*parents*/, const auto& created) {
      leaves.insert(leaves.end(), created.begin(), created.end());
    });
    std::vector<TetrahedronId> created = refinement_.split_failing(std::move(failing));
    any = any || !created.empty();
    refinement_.refine_to_targets(std::move(created));
    refinement_.set_observer({});
    if (state_.budget_spent) break;  // some of the leaves may be merged
    std::erase_if(leaves, [&](TetrahedronId t) { return !state_.hierarchy.is_leaf(t); });
    failing.clear();
    if (kNewPart * static_cast<double>(state_.hierarchy.leaf_count()) > static_cast<double>(leaves.size()))
      failing = shown_.failing_among(leaves);
  }
  return any;
}

/// Compares the bodies shown with the best ones so far, after torn ones are mended; returns whether
/// refinement should continue.
bool Certification::compare_bodies(BodyRounds& bodies) {
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

/// Returns to the best bodies.
RefinementEnd Certification::end(RefinementEnd reason, BodyRounds& bodies) {
  if (!bodies.since_best.splits.empty()) {
    refinement_.undo_splits(bodies.since_best);
    state_.budget_spent = false;
    if (!bodies.best_is_measured) {
      shown_.measure();
    } else if (bodies.best_shown) {
      mending_.go_back(std::move(*bodies.best_shown));
    }
  }
  refinement_.record_in(nullptr);
  mending_.measure();
  mending_.move_interfaces(kMendedPartAtEnd);
  return shown_.comparison().within() ? RefinementEnd::kReached : reason;
}

/// Returns the distance that moves of interfaces may lead to.
double Certification::allowed_distance() const {
  const InterfaceComparison& comparison = shown_.comparison();
  if (comparison.within()) return state_.options.interface_error;
  const double farther = state_.options.conservation_wanted ? 1 + kFartherPart : 1;
  return std::max(state_.options.interface_error, farther * comparison.greatest_of_shown());
}

/// Returns whether distances and bodies are as they are wanted after interfaces have been moved.
bool Certification::is_unharmed(const BodyReport& before, double allowed) const {
  const BodyReport& now = mending_.report();
  for (BodyId b(0); b.value < now.mesh.size(); ++b.value) {
    if (is_worse(now, before, b)) return false;
  }
  return std::ranges::includes(before.contacts, now.contacts) &&
         shown_.comparison().greatest_of_shown() <= allowed;
}

/// Returns the leaves where moves have brought interfaces too far from the input's, or have changed a body
/// that is shown less well than before or touches another one that it did not touch. `all`: all leaves near
/// such bodies.
std::vector<TetrahedronId> Certification::harmed_leaves(const BodyReport& before, Conservation& conservation,
                                                        bool all) const {
  std::vector<TetrahedronId> leaves = shown_.failing_leaves();
  const BodyReport& now = mending_.report();
  IdVector<BodyId, char> worse(now.mesh.size(), 0);
  bool any = false;
  for (BodyId b(0); b.value < worse.size(); ++b.value) {
    worse[b] = is_worse(now, before, b) ? 1 : 0;
    any = any || worse[b] != 0;
  }
  const ExtractedInterfaces& shown = shown_.extracted();
  for (std::uint32_t t = 0; t < shown.bodies.size(); ++t) {
    const auto [a, b] = std::minmax(shown.bodies[t][0], shown.bodies[t][1]);
    const std::array pair{a, b};
    if (std::ranges::binary_search(now.contacts, pair) && !std::ranges::binary_search(before.contacts, pair))
      state_.add_leaf_at(shown.mesh.centroid(t), 0, leaves);
  }
  if (any && all) {
    conservation.add_leaves_of(worse, leaves);
  } else if (any) {
    const auto changed = conservation.leaves_gained_or_lost(worse);
    leaves.insert(leaves.end(), changed.begin(), changed.end());
  }
  return leaves;
}

RefinementEnd Certification::conserve() {
  if (!state_.options.conserve) return end_;
  volumes_.alternate([this] { move_for_volumes(); }, [this] { end_ = measure_and_refine(); });
  finish();
  return end_;
}

/// Limits how far the polygons of the leaves with these shown triangles may move, so that distances stay
/// within the target.
void Certification::limit_moves(CarefulConservation& conservation, const ShownInterfaces::Measured& before,
                                double most, const std::vector<std::uint32_t>& triangles) const {
  const std::vector<double> slack = before.comparison.slack(most);
  std::vector<Vec3> places;
  std::vector<double> limits;
  for (const std::uint32_t t : triangles) {
    if (slack[t] >= most) continue;
    places.push_back(before.extracted.mesh.centroid(t));
    limits.push_back(kSurely * slack[t]);
  }
  const std::vector<TetrahedronId> leaves = state_.leaves_at(places);
  for (std::size_t i = 0; i < leaves.size(); ++i) conservation.limits().limit(leaves[i], limits[i]);
  conservation.limits().update_ranges();
}

/// Moves interfaces; returns false if something is too far by it. `before`: what was shown and measured
/// before the last moves.
bool Certification::try_moves(CarefulConservation& conservation, const ShownInterfaces::Measured& before,
                              double allowed) {
  conservation.move();
  shown_.measure_moved(before);
  return shown_.comparison().greatest_of_shown() <= allowed;
}

/// Moves interfaces for the volumes of bodies as far as no body changes by it.
void Certification::move_carefully(CarefulConservation free, const ShownInterfaces::Measured& before,
                                   double allowed) {
  const double most = kFartherMoves * free.interfaces().displacement(free.moves());
  CarefulConservation careful = free;
  if (try_moves(free, before, allowed)) return;
  std::vector<std::uint32_t> all(before.extracted.mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  careful.limits().limit_all(most);
  limit_moves(careful, before, most, all);
  careful.solve();
  for (int tries = 1; tries < kMostTries; ++tries) {
    limit_moves(free, before, most, shown_.comparison().shown_near_far());
    free.solve();
    if (careful.is_as_good_as(free)) break;
    if (try_moves(free, shown_.measured(), allowed)) return;
  }
  if (try_moves(careful, before, allowed)) return;
  careful.move_back();
  shown_.go_back(before);
}

/// Moves interfaces also where bodies may change by it. Where that does harm, they are held. Returns whether
/// they have moved.
bool Certification::move_freely(double allowed) {
  const BodyReport before = mending_.report();
  Conservation conservation(state_);
  conservation.conserve();
  if (!conservation.has_moved()) return false;
  const auto measure = [&] {
    shown_.measure_after_moves();
    mending_.measure();
  };
  measure();
  const int most_held = state_.options.conservation_wanted ? kMostHeld : kMostHeldUnasked;
  for (int held = 0; held < most_held && !is_unharmed(before, allowed); ++held) {
    conservation.hold(harmed_leaves(before, conservation, held > 1), held);
    measure();
  }
  if (is_unharmed(before, allowed)) return true;
  conservation.move_back();
  return false;
}

/// Moves interfaces for the volumes of bodies.
void Certification::move_for_volumes() {
  const double allowed = allowed_distance();
  shown_.set_target(allowed);
  if (!shown_.comparison().knows_each()) shown_.measure(true);
  find_contacts(state_, state_.leaves());
  const ShownInterfaces::Measured before = shown_.measured();
  CarefulConservation careful(state_);
  careful.solve();
  const bool freely = careful.missing_part() > kMuchMissing;
  const bool moved = freely && move_freely(allowed);
  if (freely && !moved) {
    shown_.go_back(before);
    mending_.measure();
  }
  if (!moved && careful.has_moves()) move_carefully(std::move(careful), before, allowed);
  shown_.set_target(state_.options.interface_error);
}

}  // namespace adamas::interfaces
