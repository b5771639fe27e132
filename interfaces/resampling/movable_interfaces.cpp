#include "interfaces/resampling/movable_interfaces.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/resampling/cell_evaluation.h"

namespace adamas::interfaces {

namespace {

constexpr std::size_t kLeavesPerTask = 256;
/// A distance may fall by this part of it, so that it keeps its sign.
constexpr double kMostLost = 0.9;
/// Corners of polygons closer to a vertex than this part of their edge may coincide with others.
constexpr double kLeastWeight = 1e-6;

/// The interface that divides a leaf.
struct Division {
  InterfaceId interface;
  std::array<double, 4> values{};  ///< half of the difference of the functions of its two bodies
};

/// Returns the interface of two bodies that share a leaf by one polygon, if its functions are equal on it;
/// none if they are not, or the polygon ends close to a vertex. `problem`: reduced to these bodies.
std::optional<Division> division_of(const OwnershipProblem& problem) {
  if (problem.candidates.size() != 2) return {};
  const auto functions = [&](std::size_t c) {
    return std::span(problem.functions).subspan(problem.candidates[c].first, problem.candidates[c].count);
  };
  const LinearFunction *first = nullptr, *second = nullptr;
  for (const LinearFunction& f : functions(0)) {
    for (const LinearFunction& g : functions(1)) {
      if (f.key / 2 == g.key / 2) first = &f, second = &g;
    }
  }
  if (first == nullptr) return {};
  const auto is_least = [&](std::size_t v, std::size_t w, double t) {
    const auto value = [&](const LinearFunction& f) { return (1 - t) * f.values[v] + t * f.values[w]; };
    const double here = std::max(value(*first), value(*second));
    for (const LinearFunction& f : problem.functions) {
      if (f.key / 2 != first->key / 2 && value(f) < here) return false;
    }
    return true;
  };
  Division result{InterfaceId(static_cast<std::size_t>(first->key / 2)), {}};
  const double sign = first->key % 2 == 0 ? 0.5 : -0.5;
  for (std::size_t v = 0; v < 4; ++v) result.values[v] = sign * (first->values[v] - second->values[v]);
  bool any = false;
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t w = v + 1; w < 4; ++w) {
      const double a = result.values[v], b = result.values[w];
      if ((a > 0) == (b > 0)) continue;
      const double t = a / (a - b);
      if (t < kLeastWeight || t > 1 - kLeastWeight || !is_least(v, w, t)) return {};
      any = true;
    }
  }
  return any ? std::optional(result) : std::nullopt;
}

}  // namespace

double MovableInterfaces::Place::moved(double by) const { return distance + std::clamp(by, least, greatest); }

MovableInterfaces::MovableInterfaces(ResamplingState& state, double most)
    : state_(state),
      most_(most),
      divided_of_(state.hierarchy.tetrahedron_slots(), kNoPlace),
      elsewhere_(state.source.network->table().body_count(), 0.0) {
  first_places_.assign(state.hierarchy.vertex_slots(), kNoPlace);
  state.hierarchy.for_each_vertex([&](VertexId v) {
    first_places_[v] = static_cast<std::uint32_t>(places_.size());
    for (const NearDistance& near : state.hierarchy.payload(v).distances.near)
      places_.push_back({near.distance});
  });
  find_leaves();
  set_places();
  update_ranges();
  auto contacts = std::make_shared<std::vector<CellContacts>>();
  contacts->reserve(divided_.size());
  for (const DividedLeaf& divided : divided_)
    contacts->push_back(state.hierarchy.payload(divided.leaf).contacts);
  contacts_ = std::move(contacts);
}

std::vector<std::pair<BodyId, double>> MovableInterfaces::volumes_in(TetrahedronId leaf,
                                                                     CellOwnership& owners) const {
  thread_local std::vector<OwnedTetrahedron> parts;
  partition_cell(owners, parts);
  const double volume = state_.volume(leaf);
  std::vector<std::pair<BodyId, double>> result;
  for (const OwnedTetrahedron& part : parts)
    result.emplace_back(part.owner, volume * volume_fraction(part.corners));
  return result;
}

void MovableInterfaces::find_leaves() {
  struct Found {
    std::optional<Division> division;
    std::vector<std::pair<BodyId, double>> volumes;  ///< if the leaf is not divided
  };
  const std::vector<TetrahedronId> leaves = state_.leaves();
  std::vector<Found> found(leaves.size());
  parallel_chunks(leaves.size(), kLeavesPerTask, [&](std::size_t first, std::size_t last) {
    CellOwnership owners;
    for (std::size_t i = first; i < last; ++i) {
      const auto& contacts = state_.hierarchy.payload(leaves[i]).contacts;
      state_.ownership(leaves[i], owners);
      if (contacts.polygon_count() == 1) {
        keep_owners(owners.problem);
        found[i].division = division_of(owners.problem);
      }
      if (!found[i].division) found[i].volumes = volumes_in(leaves[i], owners);
    }
  });
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto& [division, volumes] = found[i];
    if (division) {
      divided_of_[leaves[i]] = static_cast<std::uint32_t>(divided_.size());
      divided_.push_back({leaves[i], division->interface, state_.volume(leaves[i]), {}, division->values});
    } else if (state_.hierarchy.payload(leaves[i]).contacts.empty()) {
      whole_.push_back(leaves[i]);
    } else {
      shared_.push_back(leaves[i]);
    }
    for (const auto& [body, volume] : volumes) elsewhere_[body] += volume;
  }
}

/// Lets a distance change as long as it keeps its sign.
void MovableInterfaces::let_move(Place& place) const {
  const double falls = std::min(most_, kMostLost * std::abs(place.distance));
  place.least = place.distance > 0 ? -falls : -most_;
  place.greatest = place.distance > 0 ? most_ : falls;
}

/// Finds the places of divided leaves, and how their distances may change.
void MovableInterfaces::set_places() {
  for (DividedLeaf& divided : divided_) {
    const auto vertices = state_.hierarchy.vertices(divided.leaf);
    for (std::size_t v = 0; v < 4; ++v) {
      const auto& near = state_.hierarchy.payload(vertices[v]).distances.near;
      const auto at = std::ranges::lower_bound(near, divided.interface, {}, &NearDistance::interface);
      divided.places[v] = kNoPlace;
      if (at == near.end() || at->interface != divided.interface) continue;
      divided.places[v] = first_places_[vertices[v]] + static_cast<std::uint32_t>(at - near.begin());
      let_move(places_[divided.places[v]]);
    }
  }
  for (const TetrahedronId leaf : shared_) hold(leaf);
}

void MovableInterfaces::hold(TetrahedronId leaf) {
  for (const VertexId v : state_.hierarchy.vertices(leaf)) {
    const std::size_t count = state_.hierarchy.payload(v).distances.near.size();
    for (std::size_t n = 0; n < count; ++n) {
      Place& place = places_[first_places_[v] + n];
      place.least = place.greatest = 0;
    }
  }
}

void MovableInterfaces::update_ranges() {
  ranges_.assign(state_.shifts.size(), {0, 0});
  for (const DividedLeaf& divided : divided_) {
    auto& [least, greatest] = ranges_[divided.interface];
    for (const std::uint32_t p : divided.places) {
      if (p == kNoPlace) continue;
      least = std::min(least, places_[p].least);
      greatest = std::max(greatest, places_[p].greatest);
    }
  }
}

std::array<double, 4> MovableInterfaces::values(const DividedLeaf& divided, const Moves& moves) const {
  std::array<double, 4> result = divided.values;
  for (std::size_t v = 0; v < 4; ++v) {
    if (divided.places[v] != kNoPlace) result[v] = places_[divided.places[v]].moved(moves[divided.interface]);
  }
  return result;
}

ExchangedVolumes MovableInterfaces::measure(const Moves& moves) const {
  struct Part {
    double volume = 0;     ///< of the interface's first body
    double exchanged = 0;  ///< what it gains by a move
  };
  std::vector<Part> parts(divided_.size());
  parallel_for(divided_.size(), 1024, [&](std::size_t i) {
    const DividedLeaf& divided = divided_[i];
    const PositivePart part = positive_part(values(divided, moves));
    parts[i].volume = divided.volume * part.volume;
    const double by = moves[divided.interface];
    for (std::size_t v = 0; v < 4; ++v) {
      if (divided.places[v] == kNoPlace) continue;
      const Place& place = places_[divided.places[v]];
      if (place.least < place.greatest && place.least <= by && by <= place.greatest)
        parts[i].exchanged += divided.volume * part.growth[v];
    }
  });
  const InterfaceTable& table = state_.source.network->table();
  ExchangedVolumes result{elsewhere_, {}};
  IdVector<InterfaceId, double> exchanged(moves.size(), 0.0);
  for (std::size_t i = 0; i < divided_.size(); ++i) {
    const auto& [first, second] = table.sides(divided_[i].interface);
    result.volumes[first] += parts[i].volume;
    result.volumes[second] += divided_[i].volume - parts[i].volume;
    exchanged[divided_[i].interface] += parts[i].exchanged;
  }
  // An interface moves by half of the difference of its bodies' functions.
  for (InterfaceId i(0); i.value < exchanged.size(); ++i.value) {
    if (exchanged[i] > 0) result.exchanges.emplace_back(table.sides(i), 0.5 * exchanged[i]);
  }
  std::ranges::sort(result.exchanges, {}, &Exchange::first);
  return result;
}

double MovableInterfaces::displacement(const DividedLeaf& divided, const Moves& moves) const {
  const std::array<double, 4> after = values(divided, moves);
  const auto& before = divided.values;
  const auto vertices = state_.hierarchy.vertices(divided.leaf);
  double greatest = 0;
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t w = v + 1; w < 4; ++w) {
      if ((before[v] > 0) == (before[w] > 0)) continue;
      const double by = std::abs(before[v] / (before[v] - before[w]) - after[v] / (after[v] - after[w]));
      greatest = std::max(greatest, by * distance(state_.hierarchy.position(vertices[v]),
                                                  state_.hierarchy.position(vertices[w])));
    }
  }
  return greatest;
}

double MovableInterfaces::displacement(TetrahedronId leaf, const Moves& moves) const {
  return divided_of_[leaf] == kNoPlace ? 0 : displacement(divided_[divided_of_[leaf]], moves);
}

double MovableInterfaces::displacement(const Moves& moves) const {
  double greatest = 0;
  for (const DividedLeaf& divided : divided_) greatest = std::max(greatest, displacement(divided, moves));
  return greatest;
}

/// If neither end of an edge changes by more than e and both keep their signs, the point where the function
/// is zero moves by at most e times the length of the edge over the difference of its ends.
void MovableInterfaces::limit(const DividedLeaf& divided, double displacement) {
  const auto vertices = state_.hierarchy.vertices(divided.leaf);
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t w = v + 1; w < 4; ++w) {
      if ((divided.values[v] > 0) == (divided.values[w] > 0)) continue;
      const double length =
          distance(state_.hierarchy.position(vertices[v]), state_.hierarchy.position(vertices[w]));
      const double most = displacement * std::abs(divided.values[v] - divided.values[w]) / length;
      for (const std::uint32_t p : {divided.places[v], divided.places[w]}) {
        if (p == kNoPlace) continue;
        places_[p].least = std::clamp(places_[p].least, -most, most);
        places_[p].greatest = std::clamp(places_[p].greatest, -most, most);
      }
    }
  }
}

void MovableInterfaces::limit(TetrahedronId leaf, double displacement) {
  if (divided_of_[leaf] != kNoPlace) limit(divided_[divided_of_[leaf]], displacement);
}

void MovableInterfaces::limit_all(double displacement) {
  for (const DividedLeaf& divided : divided_) limit(divided, displacement);
}

/// Returns whether a distance changes at a vertex of the leaf.
bool MovableInterfaces::moves_at(TetrahedronId leaf, const Moves& moves) const {
  return std::ranges::any_of(state_.hierarchy.vertices(leaf), [&](VertexId v) {
    const auto& near = state_.hierarchy.payload(v).distances.near;
    for (std::size_t n = 0; n < near.size(); ++n) {
      const Place& place = places_[first_places_[v] + n];
      if (place.moved(moves[near[n].interface]) != place.distance) return true;
    }
    return false;
  });
}

std::vector<TetrahedronId> MovableInterfaces::move(const Moves& moves) {
  state_.hierarchy.for_each_vertex([&](VertexId v) {
    auto& near = state_.hierarchy.payload(v).distances.near;
    for (std::size_t n = 0; n < near.size(); ++n)
      near[n].distance = places_[first_places_[v] + n].moved(moves[near[n].interface]);
  });
  std::vector<TetrahedronId> moved;
  std::vector<const CellContacts*> before;
  const auto forget = [&](TetrahedronId leaf, const CellContacts& contacts) {
    CellRecord& cell = state_.hierarchy.payload(leaf);
    cell.forget_contacts();
    if (moves_at(leaf, moves)) {
      moved.push_back(leaf);
      before.push_back(&contacts);
    } else {
      cell.contacts = contacts;
      cell.has_contacts = true;
    }
  };
  auto contacts = contacts_->begin();
  for (const DividedLeaf& divided : divided_) forget(divided.leaf, *contacts++);
  const CellContacts none;
  for (const TetrahedronId leaf : whole_) forget(leaf, none);
  find_contacts(state_, moved);
  std::vector<TetrahedronId> changed;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const auto& now = state_.hierarchy.payload(moved[i]).contacts;
    if (!now.has_polygons_of(*before[i])) changed.push_back(moved[i]);
  }
  return changed;
}

}  // namespace adamas::interfaces
