#include "interfaces/resampling/conservation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

namespace {

/// The greatest number of steps of Newton's method. Usually four or five are enough, unless bodies are about
/// to vanish.
constexpr int kMostSteps = 20;
/// Steps end when so many of them, one after another, are idle.
constexpr int kMostIdleSteps = 3;
/// When some vertices are held, volumes are closed by moves at this part of the leaves that two bodies have
/// in common, and at kLeastLeaves at least.
constexpr std::size_t kFewLeaves = 16, kLeastLeaves = 8;

double reach_of(const ResamplingState& state) {
  double reach = state.options.interface_error;
  for (const double shift : state.shifts)
    reach = std::max(reach, state.options.interface_error + std::abs(shift));
  return reach;
}

}  // namespace

Conservation::Conservation(ResamplingState& state)
    : state_(state),
      leaves_(state, reach_of(state)),
      wanted_(filling_volumes(state.source)),
      before_(state),
      bases_(before_),
      held_(state.hierarchy.vertex_slots(), 0) {}

/// Begins moves from where interfaces are now.
void Conservation::begin_moves(const IdVector<VertexId, double>& gains) {
  gains_ = gains;
  moves_.assign(state_.shifts.size(), 0.0);
  bases_ = KeptDistances(state_);
}

/// Returns the bounds of the present move of an interface; there is room for none at least.
std::array<double, 2> Conservation::range(InterfaceId i) const {
  const double most = state_.options.interface_error;
  return {std::min(0.0, -most - bases_.shifts()[i]), std::max(0.0, most - bases_.shifts()[i])};
}

/// Makes these the present moves.
void Conservation::move_to(const Shifts& moves) {
  moves_ = moves;
  const double most = state_.options.interface_error;
  bases_.for_each(state_, [&](VertexId v, NearDistance& near, double base) {
    near.distance = gains_[v] > 0 ? base + gains_[v] * moves[near.interface] : base;
  });
  // Vertices that have taken part in other moves may be farther than the rest.
  before_.for_each(state_, [&](VertexId v, NearDistance& near, double before) {
    const double unmoved = before - before_.shifts()[near.interface];
    if (gains_[v] > 0) near.distance = std::clamp(near.distance, unmoved - most, unmoved + most);
  });
}

/// Moves interfaces at vertices with gains until volumes agree in these leaves; returns what is known of the
/// bodies in the end.
UnknownVolumes Conservation::move(const LeavesNearInterfaces& leaves) {
  std::optional<std::vector<Exchange>> at_contacts;
  const auto measure = [&](const Shifts& moves) {
    state_.report("conserving volumes");
    if (moves != moves_) move_to(moves);
    return leaves.measure(gains_, at_contacts);
  };
  UnknownVolumes unknowns(wanted_.size());
  Shifts best = moves_;
  solve_equations({.table = state_.source.network->table(),
                   .wanted = wanted_,
                   .enough = kVolumesAgree * state_.source.box.volume(),
                   .most_steps = kMostSteps,
                   .most_idle_steps = kMostIdleSteps,
                   .range = [this](InterfaceId i) { return range(i); },
                   .measure = measure},
                  best, unknowns);
  if (moves_ != best) move_to(best);
  return unknowns;
}

void Conservation::conserve() {
  begin_moves(IdVector<VertexId, double>(held_.size(), 1.0));
  unknowns_ = move(leaves_);
  keep_moves();
  forget_contacts(leaves_);
}

/// Adds the present moves to the state's shifts.
void Conservation::keep_moves() {
  for (InterfaceId i(0); i.value < moves_.size(); ++i.value) {
    has_moved_ = has_moved_ || moves_[i] != 0;
    state_.shifts[i] += moves_[i];
  }
}

/// Returns gains of a few vertices for each pair of bodies, none of which is held.
IdVector<VertexId, double> Conservation::gains_of_few() const {
  IdVector<VertexId, double> gains(held_.size(), 0.0);
  std::map<std::array<BodyId, 2>, std::vector<TetrahedronId>> free;
  for (const auto& [pair, leaf] : leaves_.exchanging_leaves()) {
    if (std::ranges::none_of(state_.hierarchy.vertices(leaf), [&](VertexId v) { return held_[v] != 0; }))
      free[pair].push_back(leaf);
  }
  for (const auto& [pair, leaves] : free) {
    const std::size_t count = std::min(leaves.size(), std::max(kLeastLeaves, leaves.size() / kFewLeaves));
    for (std::size_t i = 0; i < count; ++i) {
      for (const VertexId v : state_.hierarchy.vertices(leaves[i])) gains[v] = 1;
    }
  }
  return gains;
}

/// Marks vertices as held, and moves them back.
void Conservation::hold_vertices(const std::vector<TetrahedronId>& leaves, int rings) {
  IdVector<VertexId, char> chosen(held_.size(), 0);
  const auto choose = [&](TetrahedronId t) {
    for (const VertexId v : state_.hierarchy.vertices(t)) chosen[v] = held_[v] = 1;
  };
  for (const TetrahedronId t : leaves) choose(t);
  for (int ring = 0; ring < rings; ++ring) {
    const IdVector<VertexId, char> inner = chosen;
    for (const TetrahedronId t : leaves_.leaves()) {
      if (std::ranges::any_of(state_.hierarchy.vertices(t), [&](VertexId v) { return inner[v] != 0; }))
        choose(t);
    }
  }
  before_.for_each(state_, [&](VertexId v, NearDistance& near, double before) {
    if (held_[v] != 0) near.distance = before;
  });
}

void Conservation::hold(const std::vector<TetrahedronId>& leaves, int rings) {
  hold_vertices(leaves, rings);
  begin_moves(gains_of_few());
  IdVector<VertexId, char> changed = held_;
  for (VertexId v(0); v.value < changed.size(); ++v.value)
    changed[v] = held_[v] != 0 || gains_[v] > 0 ? 1 : 0;
  LeavesNearInterfaces few = leaves_;
  few.keep_those_at(changed);
  const UnknownVolumes before = std::exchange(unknowns_, move(few));
  forget_contacts(few);
  const double enough = kVolumesAgree * state_.source.box.volume();
  bool closed = true;
  for (BodyId b(0); b.value < before.size(); ++b.value)
    closed = closed && (std::abs(unknowns_[b].missing) <= enough || std::abs(before[b].missing) > enough);
  if (closed) return;
  move_to(Shifts(moves_.size(), 0.0));
  IdVector<VertexId, double> all(held_.size(), 1.0);
  for (VertexId v(0); v.value < all.size(); ++v.value) all[v] = held_[v] != 0 ? 0 : 1;
  begin_moves(all);
  unknowns_ = move(leaves_);
  keep_moves();
  forget_contacts(leaves_);
}

std::vector<TetrahedronId> Conservation::leaves_gained_or_lost(const IdVector<BodyId, char>& bodies) {
  const std::vector<std::vector<BodyId>> now = leaves_.owners(bodies);
  const auto set_distances = [this](const KeptDistances& to) {
    to.for_each(state_, [](VertexId, NearDistance& near, double kept) { near.distance = kept; });
  };
  const KeptDistances present(state_);
  set_distances(before_);
  const std::vector<std::vector<BodyId>> before = leaves_.owners(bodies);
  set_distances(present);
  std::vector<TetrahedronId> result;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i] != before[i]) result.push_back(leaves_.leaves()[i]);
  }
  return result;
}

void Conservation::add_leaves_of(const IdVector<BodyId, char>& bodies,
                                 std::vector<TetrahedronId>& leaves) const {
  for (const TetrahedronId t : leaves_.leaves()) {
    const bool known = std::ranges::any_of(state_.hierarchy.vertices(t), [&](VertexId v) {
      return std::ranges::any_of(state_.hierarchy.payload(v).distances.bodies,
                                 [&](BodyId b) { return bodies[b] != 0; });
    });
    if (known) leaves.push_back(t);
  }
}

void Conservation::move_back() {
  before_.restore(state_);
  has_moved_ = false;
}

void Conservation::forget_contacts(const LeavesNearInterfaces& leaves) {
  for (const TetrahedronId t : leaves.leaves()) state_.hierarchy.payload(t).forget_contacts();
}

}  // namespace adamas::interfaces
