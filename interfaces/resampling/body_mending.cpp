#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/base/parallel.h"
#include "interfaces/resampling/resampler.h"

namespace adamas {

namespace {

/// How far a signed distance is moved at most, in relation to the interface error wanted.
constexpr double kMostRaised = 0.5;
/// By how much a body is raised above the others at the middle of a thin place, in relation to its thickness,
/// so that it also owns what is between such places.
constexpr double kMargin = 0.25;
/// How often distances are moved back where interfaces are too far from the input's: by half first, then
/// wholly, and after so many times in the cells beside as well.
constexpr int kMostReturns = 5, kReturnsAlone = 2;
/// Raising one place lowers others; what is still torn after so many passes stays so.
constexpr int kMostPasses = 12;

double value_at(const OwnershipProblem& problem, BodyId body, const Weights& at) {
  for (const OwnershipProblem::Candidate& candidate : problem.candidates) {
    if (candidate.owner == body.value) return problem.value(candidate, at);
  }
  return -HUGE_VAL;
}

NearDistance* find_near(VertexDistances& vertex, InterfaceId interface) {
  const auto found = std::ranges::find(vertex.near, interface, &NearDistance::interface);
  return found == vertex.near.end() ? nullptr : &*found;
}

}  // namespace

/// What raises a body at the middle of a thin place over the one that owns it; nothing where it is the owner.
std::optional<Resampler::Raise> Resampler::raise_at(const ThinPlace& place) const {
  const TetrahedronId leaf = leaf_at(place.middle);
  CellOwnership owners;
  ownership(leaf, owners);
  if (owners.pure()) return {};
  const Weights at = frame(leaf).weights(place.middle);
  const BodyId owner(owners.problem.owner(at));
  if (owner == place.body) return {};
  const double below = value_at(owners.problem, owner, at) - value_at(owners.problem, place.body, at);
  if (!std::isfinite(below)) return {};
  for (const CellOwnership::Interface& interface : owners.interfaces) {
    const auto& [a, b] = source_.network->table().sides(interface.id);
    // One rises and the other sinks.
    const double by = 0.5 * below + kMargin * place.thickness;
    if (a == place.body && b == owner) return Raise{leaf, interface.id, by};
    if (b == place.body && a == owner) return Raise{leaf, interface.id, -by};
  }
  return {};
}

/// Moves the signed distances at the corners of cells that give places within torn bodies to others, until
/// they no longer do, within a part of the interface error. Returns the distances that were moved, as they
/// were without shifts.
std::vector<Resampler::Moved> Resampler::raise_torn_bodies() {
  const double most = kMostRaised * options_.interface_error;
  const IdVector<BodyId, char> wrong = wrong_bodies();
  std::vector<Moved> all;
  std::vector<std::optional<Raise>> raises(thin_places_->size());
  bool again = false;  // Only places that were torn are looked at again, until none is.
  for (int pass = 0; pass < kMostPasses; ++pass) {
    parallel_for(raises.size(), 256, [&](std::size_t i) {
      const ThinPlace& place = (*thin_places_)[i];
      if (wrong[place.body] != 0 && (!again || raises[i])) raises[i] = raise_at(place);
    });
    // The farthest move that any place asks of a distance, which is made once.
    std::vector<Moved> moves;
    for (const std::optional<Raise>& raise : raises) {
      if (!raise) continue;
      for (const VertexId v : hierarchy_.vertices(raise->leaf))
        moves.push_back({v, raise->interface, raise->by});
    }
    std::ranges::sort(moves, [](const Moved& x, const Moved& y) {
      return std::tuple(x.vertex, x.interface, -std::abs(x.distance), x.distance) <
             std::tuple(y.vertex, y.interface, -std::abs(y.distance), y.distance);
    });
    const auto same = [](const Moved& x, const Moved& y) {
      return x.vertex == y.vertex && x.interface == y.interface;
    };
    moves.erase(std::unique(moves.begin(), moves.end(), same), moves.end());
    const std::size_t known = all.size();
    bool any = false;
    for (const Moved& move : moves) {
      NearDistance* near = find_near(hierarchy_.payload(move.vertex).distances, move.interface);
      if (near == nullptr) continue;
      const auto end = all.begin() + static_cast<std::ptrdiff_t>(known);
      const auto found = std::lower_bound(all.begin(), end, move, [](const Moved& x, const Moved& y) {
        return std::tie(x.vertex, x.interface) < std::tie(y.vertex, y.interface);
      });
      const bool first = found == end || !same(*found, move);
      const double original = first ? near->distance : found->distance + shifts_[move.interface];
      const double moved = std::clamp(near->distance + move.distance, original - most, original + most);
      if (moved == near->distance) continue;
      if (first) all.push_back({move.vertex, move.interface, original - shifts_[move.interface]});
      near->distance = moved;
      any = true;
    }
    std::inplace_merge(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(known), all.end(),
                       [](const Moved& x, const Moved& y) {
                         return std::tie(x.vertex, x.interface) < std::tie(y.vertex, y.interface);
                       });
    if (!any && !again) break;
    again = any;
  }
  return all;
}

/// The corners of cells, in order.
std::vector<VertexId> Resampler::corners_of(const std::vector<TetrahedronId>& cells) const {
  std::vector<VertexId> corners;
  for (const TetrahedronId t : cells) {
    for (const VertexId v : hierarchy_.vertices(t)) corners.push_back(v);
  }
  std::ranges::sort(corners);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// The leaves that have one of these corners, which are in order.
std::vector<TetrahedronId> Resampler::leaves_at(const std::vector<VertexId>& corners) const {
  std::vector<TetrahedronId> result = leaves();
  std::erase_if(result, [&](TetrahedronId t) {
    return std::ranges::none_of(hierarchy_.vertices(t),
                                [&](VertexId v) { return std::ranges::binary_search(corners, v); });
  });
  return result;
}

/// Moves distances back to a share of what they were moved by, at the corners of the given cells.
void Resampler::move_back(const std::vector<Moved>& moved, const std::vector<TetrahedronId>& cells,
                          double share) {
  const std::vector<VertexId> corners = corners_of(cells);
  for (const Moved& m : moved) {
    if (!std::ranges::binary_search(corners, m.vertex)) continue;
    double& distance = find_near(hierarchy_.payload(m.vertex).distances, m.interface)->distance;
    const double original = m.distance + shifts_[m.interface];
    distance = original + share * (distance - original);
  }
}

/// Mends torn bodies by moving interfaces, where that leaves `most_torn` faults at most and less than half,
/// loses and joins no more bodies, and keeps distances as they were wanted; else nothing changes. Returns
/// whether it did.
bool Resampler::mend_bodies(ExtractedInterfaces& shown, std::size_t most_torn) {
  const BodyFaults before = bodies_->faults(options_.interface_error);
  // Interfaces that conservation moves too could be moved so far that no cell is within the target.
  if (before.torn == 0 || options_.conserve || mending_is_hopeless_) return false;
  const bool within = comparison_->within();
  find_thin_places();
  const std::vector<Moved> moved = raise_torn_bodies();
  if (moved.empty()) return false;
  BodyFaults now;
  const auto measure = [&] {
    shown = measure_shown();
    bodies_->measure(shown);
    now = bodies_->faults(options_.interface_error);
  };
  measure();
  mending_is_hopeless_ = now.torn >= before.torn || now.lost_or_joined > before.lost_or_joined;
  if (!mending_is_hopeless_ && 2 * now.torn <= before.torn) {
    for (int i = 1; within && !comparison_->within() && i <= kMostReturns; ++i) {
      std::vector<TetrahedronId> failing = failing_leaves(shown.mesh);
      if (failing.empty()) break;
      if (i > kReturnsAlone) failing = leaves_at(corners_of(failing));
      move_back(moved, failing, i == 1 ? 0.5 : 0);
      measure();
    }
    if (now.torn <= most_torn && now.lost_or_joined <= before.lost_or_joined &&
        (comparison_->within() || !within))
      return true;
  }
  move_back(moved, leaves(), 0);
  measure();
  return false;
}

}  // namespace adamas
