#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

namespace {

/// How far a signed distance is moved at most, in relation to the interface error wanted.
constexpr double kMostRaised = 0.5;
/// By how much a body is raised above the others at the middle of a thin place, in relation to its thickness,
/// so that it also owns what is between such places.
constexpr double kMargin = 0.25;
/// How far off a mesh may be, in relation to the interface error wanted.
constexpr double kFarOff = 2;
/// How often distances are moved back where interfaces are too far from the input's: by half first, then
/// wholly, and after so many times in the cells beside as well.
constexpr int kMostReturns = 5, kReturnsAlone = 2;
/// Raising one place lowers others; what is still torn after so many passes stays so.
constexpr int kMostPasses = 12;

NearDistance* find_near(VertexDistances& vertex, InterfaceId interface) {
  const auto found = std::ranges::find(vertex.near, interface, &NearDistance::interface);
  return found == vertex.near.end() ? nullptr : &*found;
}

}  // namespace

/// What raises a body at the middle of a thin place over the one that owns it; nothing where it is the owner.
std::optional<Resampler::Raise> Resampler::raise_at(const ThinPlace& place, TetrahedronId leaf, BodyId owner,
                                                    const CellOwnership& owners) const {
  if (owners.pure() || owner == place.body) return {};
  const Weights at = frame(leaf).weights(place.middle);
  const auto& candidates = owners.problem.candidates;
  const std::size_t own = owners.candidate(place.body), other = owners.candidate(owner);
  if (own == candidates.size()) return {};
  const double below =
      owners.problem.value(candidates[other], at) - owners.problem.value(candidates[own], at);
  for (const CellOwnership::Interface& interface : owners.interfaces) {
    const auto& [a, b] = source_.network->table().sides(interface.id);
    // The one body rises by this, and the other sinks by as much.
    const double by = 0.5 * below + kMargin * place.thickness;
    if (a == place.body && b == owner) return Raise{leaf, interface.id, by};
    if (b == place.body && a == owner) return Raise{leaf, interface.id, -by};
  }
  return {};
}

/// Moves the signed distances at the corners of cells that give places within torn bodies to others, until
/// they no longer do, within a part of the interface error. Returns the distances that were moved, as they
/// were.
Resampler::Distances Resampler::raise_torn_bodies() {
  const double most = kMostRaised * options_.interface_error;
  const PlacesByLeaf all = places_by_leaf(wrong_bodies());
  Distances originals;
  std::vector<std::optional<Raise>> raises(thin_places_->size());
  bool again = false;  // Only places that were torn are looked at again, until none is.
  for (int pass = 0; pass < kMostPasses; ++pass) {
    PlacesByLeaf places = all;
    if (again) std::erase_if(places, [&](const auto& place) { return !raises[place.second]; });
    look_at(places, [&](std::uint32_t i, TetrahedronId leaf, BodyId owner, const CellOwnership& owners) {
      raises[i] = raise_at((*thin_places_)[i], leaf, owner, owners);
    });
    // Each distance is moved as far as the place that asks for most.
    Distances moves;
    for (const std::optional<Raise>& raise : raises) {
      if (!raise) continue;
      for (const VertexId v : hierarchy_.vertices(raise->leaf)) {
        double& by = moves[{v, raise->interface}];
        const double size = std::abs(raise->by);
        if (size > std::abs(by) || (size == std::abs(by) && raise->by < by)) by = raise->by;
      }
    }
    bool any = false;
    for (const auto& [where, by] : moves) {
      NearDistance* near = find_near(hierarchy_.payload(where.first).distances, where.second);
      if (near == nullptr) continue;
      const auto known = originals.find(where);
      const double original = known == originals.end() ? near->distance : known->second;
      const double moved = std::clamp(near->distance + by, original - most, original + most);
      if (moved == near->distance) continue;
      originals.emplace(where, original);
      near->distance = moved;
      any = true;
    }
    if (!any && !again) break;
    again = any;
  }
  return originals;
}

/// The corners of cells, in order.
std::vector<VertexId> Resampler::corners_of(const std::vector<TetrahedronId>& cells) const {
  std::vector<VertexId> corners;
  for (const TetrahedronId t : cells) {
    for (const VertexId v : hierarchy_.vertices(t)) corners.push_back(v);
  }
  sort_unique(corners);
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

/// Moves distances back to a share of what they were moved by; at these corners, which are in order.
void Resampler::move_back(const Distances& originals, const std::vector<VertexId>& corners, double share) {
  for (const auto& [where, original] : originals) {
    if (!std::ranges::binary_search(corners, where.first)) continue;
    double& distance = find_near(hierarchy_.payload(where.first).distances, where.second)->distance;
    distance = original + share * (distance - original);
  }
}

/// Mends torn bodies by moving interfaces, where that leaves no more than one fault of `part`, at least two,
/// loses and joins no more bodies, and keeps distances and volumes as they were wanted; else nothing changes.
/// Returns whether it did.
bool Resampler::mend_bodies(ExtractedInterfaces& shown, std::size_t part) {
  const BodyFaults before = bodies_->faults(options_.interface_error);
  // Interfaces that conservation moves too, or that distances to vertices displace, could be moved so far
  // that no cell is within the target.
  const bool moved_otherwise = options_.conserve || options_.distance != DistanceMode::kExact;
  // Nor do such moves mend what a mesh that may not grow leaves much farther off.
  const bool far_off = budget_spent_ && comparison_->greatest() > kFarOff * options_.interface_error;
  if (before.torn == 0 || moved_otherwise || far_off || mending_is_hopeless_) return false;
  const bool within = comparison_->within();
  const std::size_t off = bodies_off();
  find_thin_places();
  const Distances originals = raise_torn_bodies();
  if (originals.empty()) return false;
  const auto measure = [&] {
    shown = measure_shown(true);
    bodies_->measure(shown);
    return bodies_->faults(options_.interface_error);
  };
  BodyFaults now = measure();
  mending_is_hopeless_ = now.torn >= before.torn || now.lost_or_joined > before.lost_or_joined;
  if (!mending_is_hopeless_ && 2 * now.torn <= before.torn) {
    for (int i = 1; within && !comparison_->within() && i <= kMostReturns; ++i) {
      std::vector<VertexId> corners = corners_of(failing_leaves(shown.mesh));
      if (corners.empty()) break;
      if (i > kReturnsAlone) corners = corners_of(leaves_at(corners));
      move_back(originals, corners, i == 1 ? 0.5 : 0);
      now = measure();
    }
    if (part * now.torn <= before.torn && now.lost_or_joined <= before.lost_or_joined &&
        (comparison_->within() || !within) && bodies_off() <= off)
      return true;
  }
  for (const auto& [where, original] : originals)
    find_near(hierarchy_.payload(where.first).distances, where.second)->distance = original;
  measure();
  return false;
}

}  // namespace adamas::interfaces
