#include "interfaces/resampling/volume_refinement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "interfaces/cell_errors/volume_share.h"
#include "interfaces/network/network_measures.h"
#include "interfaces/resampling/kept_distances.h"

namespace adamas::interfaces {

namespace {

/// The bound for bodies relative to the allowed difference, so that round-off does not push them over it
/// later.
constexpr double kAimedPart = 0.99;
/// Cells are not split for a body if all of them together would contribute at most this part of the allowed
/// difference.
constexpr double kLeastPart = 0.125;
/// The cells split first are those that contribute at least this part of the greatest contribution.
constexpr double kLargePart = 0.5;
/// A body whose shape the cells show is given up if its difference has not fallen below kBetterPart of it
/// when there are kMostGrowth times more cells at its boundary.
constexpr double kBetterPart = 0.7;
constexpr double kMostGrowth = 16;
/// Cells show a body's shape if they are smaller than this part of its thickness, which is the diameter of
/// the ball with the same ratio of volume to area.
constexpr double kShownThickness = 0.125;
/// If interfaces are moved to conserve volumes, cells are first split until bodies have their volumes up to
/// kFirstSlack: a body that is nearly lost cannot be given its volume by moving, which would move all other
/// interfaces too far. If moving does not remove the rest, the slack is multiplied by kLessSlack.
constexpr double kFirstSlack = 0.5, kLessSlack = 0.25;

}  // namespace

/// Computes the goals.
void VolumeRefinement::find_goals() {
  if (!goals_.empty()) return;
  const InterfaceNetwork& network = *state_.source.network;
  const InterfaceTable& table = network.table();
  const NetworkMeasures measures =
      measure_network(network, state_.source.box, state_.source.materials.size());
  IdVector<BodyId, double> areas(table.body_count(), 0.0);
  for (InterfaceId i(0); i.value < table.interface_count(); ++i.value) {
    for (const BodyId b : table.sides(i)) areas[b] += measures.areas[i];
  }
  goals_.resize(table.body_count());
  if (state_.options.conserve) slack_ = kFirstSlack;
  for (BodyId b(0); b.value < goals_.size(); ++b.value) {
    const double wanted = state_.source.body_volumes[b], enclosed = measures.body_volumes[b];
    // A body without a volume has no relative error.
    if (!(wanted > 0 && enclosed > 0)) continue;
    const double allowed = *state_.options.volume_error * wanted;
    const double thickness = 6 * wanted / areas[b];
    goals_[b] = {wanted, enclosed, kAimedPart * allowed, areas[b] / std::pow(kShownThickness * thickness, 2)};
  }
}

/// Returns the difference of a body's volume from its goal that is allowed at present.
double VolumeRefinement::allowed(BodyId body) const {
  const VolumeGoal& goal = goals_[body];
  return std::max(goal.tolerance, slack_ * goal.wanted);
}

/// Returns the volume of a body to which cells are split: that in the input or, if smaller cells do not lead
/// to it, what its interfaces enclose.
double VolumeRefinement::goal(BodyId body) const {
  const auto& [wanted, enclosed, tolerance, cells] = goals_[body];
  const bool reachable = std::abs(enclosed - wanted) <= std::max(tolerance / kAimedPart, slack_ * wanted);
  return reachable ? wanted : enclosed;
}

/// Returns whether a body is so far from its goal that cells are split for it. Moved interfaces may give it
/// the volume in the input although that is not its goal.
bool VolumeRefinement::is_off(BodyId body, double volume) const {
  const bool has_wanted = state_.options.conserve && std::abs(volume - goals_[body].wanted) <= allowed(body);
  return !has_wanted && std::abs(volume - goal(body)) > allowed(body);
}

std::size_t VolumeRefinement::bodies_off() const {
  if (goals_.empty()) return 0;
  const IdVector<BodyId, double> volumes = state_.volumes();
  std::size_t count = 0;
  for (BodyId b(0); b.value < volumes.size(); ++b.value) {
    if (is_off(b, volumes[b])) ++count;
  }
  return count;
}

/// Updates the watched volumes after leaves have been split.
void VolumeRefinement::update(VolumeWatch& watch, const std::vector<TetrahedronId>& parents,
                              const std::vector<TetrahedronId>& created) const {
  const InterfaceTable& table = state_.source.network->table();
  for (const auto& [body, volume] : owned_volumes(table, state_.cells(parents)))
    watch.volumes[body] -= volume;
  for (const auto& [body, volume] : owned_volumes(table, state_.cells(created)))
    watch.volumes[body] += volume;
  watch.created.insert(watch.created.end(), created.begin(), created.end());
}

/// Adds those of the cells that are leaves to the bodies to whose volumes they contribute.
void VolumeRefinement::add_cells(const std::vector<TetrahedronId>& cells, std::vector<BodyOff>& off) const {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  IdVector<BodyId, std::size_t> places(state_.source.network->table().body_count(), kNone);
  for (std::size_t i = 0; i < off.size(); ++i) places[off[i].body] = i;
  const auto is_listed = [&](BodyId b) { return places[b] != kNone; };
  std::vector<std::vector<VolumeShare>> shares(cells.size());
  parallel_chunks(cells.size(), 64, [&](std::size_t first, std::size_t last) {
    CellOwnership owners;
    for (std::size_t i = first; i < last; ++i) {
      if (!state_.hierarchy.is_leaf(cells[i])) continue;
      const bool known = std::ranges::any_of(state_.hierarchy.vertices(cells[i]), [&](VertexId v) {
        return std::ranges::any_of(state_.hierarchy.payload(v).distances.bodies, is_listed);
      });
      if (!known) continue;
      const auto& triangles = state_.hierarchy.payload(cells[i]).triangles;
      const std::vector<InterfaceId> interfaces = interfaces_of(*state_.source.network, triangles);
      state_.ownership(cells[i], owners, {.interfaces = interfaces});
      shares[i] = estimate_volume_shares(*state_.source.network, state_.frame(cells[i]), owners, triangles);
      std::erase_if(shares[i], [&](const VolumeShare& share) { return !is_listed(share.body); });
    }
  });
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (const VolumeShare& share : shares[i]) {
      const double far =
          std::min(state_.hierarchy.payload(cells[i]).interface.distance, state_.frame(cells[i]).diameter());
      off[places[share.body]].cells.push_back({cells[i], share.gained, share.area * far});
    }
  }
}

/// Chooses leaves to split for a body with this volume: those with the greatest contributions to its
/// difference, at most as many as explain it completely.
void VolumeRefinement::choose_cells(BodyOff& off, double volume, std::vector<ChosenCell>& chosen) {
  std::erase_if(off.cells, [&](const auto& cell) { return !state_.hierarchy.is_leaf(cell.leaf); });
  const double tolerance = allowed(off.body), aim = goal(off.body);
  const double difference = std::abs(volume - aim);
  const auto count = static_cast<double>(off.cells.size());
  if (difference < kBetterPart * off.best) {
    off.best = difference;
    off.cells_at_best = count;
  }
  RefinementEnd& end = ends_[off.body];
  end = RefinementEnd::kSmallestCells;
  if (count > kMostGrowth * std::max(off.cells_at_best, goals_[off.body].cells)) return;
  const double sign = volume > aim ? 1 : -1;
  const double explained = std::accumulate(
      off.cells.begin(), off.cells.end(), 0.0,
      [sign](double sum, const auto& cell) { return sum + std::max(0.0, sign * cell.gained); });
  const bool is_explained = explained >= difference - tolerance;
  std::vector<ChosenCell> cells;
  for (const Cell& cell : off.cells) {
    const double gained = is_explained ? sign * cell.gained : std::max(sign * cell.gained, cell.bound);
    if (!(gained * count > kLeastPart * tolerance)) continue;
    const bool small = state_.options.distance == DistanceMode::kNearestVertex &&
                       state_.frame(cell.leaf).diameter() <= state_.options.interface_error;
    if (!state_.hierarchy.can_split(cell.leaf)) end = RefinementEnd::kDepth;
    if (state_.hierarchy.can_split(cell.leaf) && !small) cells.emplace_back(gained, cell.leaf);
  }
  if (cells.empty()) return;
  end = RefinementEnd::kReached;
  std::ranges::sort(cells, [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  double sum = 0;
  for (const auto& [gained, leaf] : cells) {
    if (gained < kLargePart * cells.front().first || sum > difference) break;
    chosen.emplace_back(gained / tolerance, leaf);
    sum += gained;
  }
}

/// Splits cells until these bodies have their volumes or splitting does not help; returns whether anything
/// was split.
bool VolumeRefinement::split_for(std::vector<BodyOff>& off, VolumeWatch& watch) {
  for (bool any = false;; any = true) {
    state_.report("refining volumes");
    std::vector<ChosenCell> chosen;
    for (BodyOff& each : off) {
      if (is_off(each.body, watch.volumes[each.body])) choose_cells(each, watch.volumes[each.body], chosen);
    }
    std::ranges::stable_sort(chosen, [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<TetrahedronId> cells;
    cells.reserve(chosen.size());
    for (const auto& [matter, leaf] : chosen) cells.push_back(leaf);
    watch.created.clear();
    std::vector<TetrahedronId> created = refinement_.split_in_order(cells);
    if (created.empty()) return any;
    refinement_.refine_to_targets(std::move(created));
    if (state_.budget_spent) return true;
    add_cells(watch.created, off);
  }
}

bool VolumeRefinement::refine() { return state_.options.volume_error && split_for_all(); }

void VolumeRefinement::alternate(const std::function<void()>& move, const std::function<void()>& measure) {
  // Cells are split between interfaces that have not moved: what some cells get by moves would be added at
  // all new vertices.
  std::optional<KeptDistances> before;
  if (state_.options.volume_error) before.emplace(state_);
  move();
  while (leave_less_to_moves()) {
    before->restore(state_);
    const bool split = refine();
    measure();
    before.emplace(state_);
    move();
    if (!split) return;
  }
}

/// After interfaces have moved: returns whether that has left bodies whose volumes are off, and less could be
/// left to moves, as it is from then on.
bool VolumeRefinement::leave_less_to_moves() {
  const double slack = std::exchange(slack_, 0.0);
  if (slack == 0 || state_.budget_spent || bodies_off() == 0) return false;
  slack_ = kLessSlack * slack;
  if (slack_ < *state_.options.volume_error) slack_ = 0;
  return true;
}

/// Splits for all bodies whose volumes are off; returns whether anything was split.
bool VolumeRefinement::split_for_all() {
  find_goals();
  ends_.assign(goals_.size(), RefinementEnd::kReached);
  for (bool any = false;;) {
    // Splitting for some bodies may change the volumes of others.
    VolumeWatch watch{state_.volumes(), {}};
    std::vector<BodyOff> off;
    for (BodyId b(0); b.value < watch.volumes.size(); ++b.value) {
      if (is_off(b, watch.volumes[b])) off.push_back({.body = b, .cells = {}});
    }
    if (state_.budget_spent || off.empty()) return any;
    add_cells(state_.leaves(), off);
    refinement_.set_observer(
        [&](const auto& parents, const auto& created) { update(watch, parents, created); });
    const bool split = split_for(off, watch);
    refinement_.set_observer({});
    if (!split) return any;
    any = true;
  }
}

}  // namespace adamas::interfaces
