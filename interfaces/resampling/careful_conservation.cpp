#include "interfaces/resampling/careful_conservation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

namespace {

/// The greatest number of steps of Newton's method. Usually four or five are enough, unless vertices may not
/// move as far as others.
constexpr int kMostSteps = 40;
/// Steps end when so many of them, one after another, are idle.
constexpr int kMostIdleSteps = 6;
/// A body gets what others of its material cannot have if this is at most so much of its own volume.
constexpr double kInheritedPart = 0.02;
/// The greatest number of times that bodies are given up, with others as their heirs.
constexpr int kMostRounds = 3;
/// The greatest number of times that vertices are held because moves would change what owns a leaf.
constexpr int kMostHeld = 6;
/// Volumes are as good as others if all of them together lack at most so many times as much.
constexpr double kAsGood = 1.25;

}  // namespace

CarefulConservation::CarefulConservation(ResamplingState& state)
    : state_(state),
      interfaces_(state, state.options.interface_error),
      wanted_(filling_volumes(state.source)),
      before_(state.shifts),
      moves_(state.shifts.size(), 0.0),
      unknowns_(wanted_.size()) {}

double CarefulConservation::enough() const { return kVolumesAgree * state_.source.box.volume(); }

bool CarefulConservation::has_moves() const {
  return std::ranges::any_of(moves_, [](double by) { return by != 0; });
}

double CarefulConservation::missing() const {
  double sum = 0;
  for (const UnknownVolume& unknown : unknowns_) sum += std::abs(unknown.missing);
  return sum;
}

double CarefulConservation::missing_part() const {
  IdVector<MaterialId, double> missing(state_.source.materials.size(), 0.0), wanted = missing;
  for (BodyId b(0); b.value < unknowns_.size(); ++b.value) {
    const MaterialId m = state_.source.network->table().material(b);
    wanted[m] += wanted_[b];
    if (!unknowns_[b].heir.valid()) missing[m] += unknowns_[b].missing;
  }
  double greatest = 0;
  for (MaterialId m(0); m.value < missing.size(); ++m.value) {
    if (wanted[m] > 0) greatest = std::max(greatest, std::abs(missing[m]) / wanted[m]);
  }
  return greatest;
}

bool CarefulConservation::is_as_good_as(const CarefulConservation& other) const {
  if (missing() > kAsGood * other.missing() + enough()) return false;
  for (BodyId b(0); b.value < unknowns_.size(); ++b.value) {
    if (std::abs(unknowns_[b].missing) > enough() && std::abs(other.unknowns_[b].missing) <= enough())
      return false;
  }
  return true;
}

/// Returns the bounds of the move of an interface; together with what moved it before it moves by at most the
/// interface error.
std::array<double, 2> CarefulConservation::range(InterfaceId i) const {
  const double most = state_.options.interface_error;
  const auto& [least, greatest] = interfaces_.range(i);
  return {std::max(least, std::min(0.0, -most - before_[i])),
          std::min(greatest, std::max(0.0, most - before_[i]))};
}

/// Changes the moves until volumes agree. What is known of the bodies in the end follows.
void CarefulConservation::take_steps() {
  solve_equations({.table = state_.source.network->table(),
                   .wanted = wanted_,
                   .enough = enough(),
                   .most_steps = kMostSteps,
                   .most_idle_steps = kMostIdleSteps,
                   .range = [this](InterfaceId i) { return range(i); },
                   .measure = [this](const auto& moves) { return interfaces_.measure(moves); }},
                  moves_, unknowns_);
}

/// Gives up the bodies that do not have their volumes, and lets large ones of their materials have what they
/// lack; returns whether there are any.
bool CarefulConservation::find_heirs() {
  const InterfaceTable& table = state_.source.network->table();
  const auto lacks = [&](BodyId b) {
    return std::abs(unknowns_[b].missing) > enough() && !unknowns_[b].heir.valid();
  };
  const std::vector<Exchange> exchanges = interfaces_.measure(moves_).exchanges;
  const IdVector<BodyId, BodyId> largest = largest_bodies(exchanges, unknowns_, wanted_);
  // Bodies that get what others leave.
  IdVector<BodyId, char> gets_rest(unknowns_.size(), 0);
  for (const auto& [pair, by] : exchanges) gets_rest[largest[pair[0]]] = 1;
  IdVector<MaterialId, BodyId> heirs(state_.source.materials.size());
  for (BodyId b(0); b.value < unknowns_.size(); ++b.value) {
    BodyId& heir = heirs[table.material(b)];
    if ((!lacks(b) || gets_rest[b] != 0) && (!heir.valid() || wanted_[b] > wanted_[heir])) heir = b;
  }
  const auto heir_of = [&](BodyId b) {
    const BodyId heir = heirs[table.material(b)];
    return lacks(b) && gets_rest[b] == 0 && heir.valid() && gets_rest[heir] == 0 ? heir : BodyId();
  };
  IdVector<BodyId, double> inherited(unknowns_.size(), 0.0);
  IdVector<BodyId, BodyId> found(unknowns_.size());
  for (BodyId b(0); b.value < unknowns_.size(); ++b.value) {
    found[b] = heir_of(b);
    if (found[b].valid()) inherited[found[b]] += unknowns_[b].missing;
  }
  bool any = false;
  IdVector<BodyId, char> given_up(unknowns_.size(), 0);
  for (BodyId b(0); b.value < unknowns_.size(); ++b.value) {
    if (!found[b].valid() || std::abs(inherited[found[b]]) > kInheritedPart * wanted_[found[b]]) continue;
    unknowns_[b].heir = found[b];
    unknowns_[b].give_up();
    given_up[b] = 1;
    any = true;
  }
  // What a body was the heir of goes with it; heirs found here are given up no more.
  for (UnknownVolume& unknown : unknowns_) {
    if (unknown.heir.valid() && given_up[unknown.heir] != 0) unknown.heir = found[unknown.heir];
  }
  return any;
}

void CarefulConservation::solve() {
  state_.report("conserving volumes");
  for (InterfaceId i(0); i.value < moves_.size(); ++i.value) {
    const auto [least, greatest] = range(i);
    moves_[i] = std::clamp(moves_[i], least, greatest);
  }
  unknowns_.assign(wanted_.size(), {});
  take_steps();
  for (int round = 0; round < kMostRounds && find_heirs(); ++round) take_steps();
}

void CarefulConservation::move() {
  for (int held = 0;; ++held) {
    const std::vector<TetrahedronId> changed = interfaces_.move(moves_);
    if (changed.empty()) break;
    if (held == kMostHeld) return move_back();
    for (const TetrahedronId leaf : changed) interfaces_.hold(leaf);
    interfaces_.update_ranges();
    solve();
  }
  for (InterfaceId i(0); i.value < moves_.size(); ++i.value) state_.shifts[i] = before_[i] + moves_[i];
}

void CarefulConservation::move_back() {
  moves_.assign(moves_.size(), 0.0);
  static_cast<void>(interfaces_.move(moves_));
  state_.shifts = before_;
}

}  // namespace adamas::interfaces
