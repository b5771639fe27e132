#include "interfaces/resampling/exchanged_volumes.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>

#include "core/base/parallel.h"
#include "core/base/sort_unique.h"
#include "interfaces/reconstruction/cut_volumes.h"

namespace adamas::interfaces {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A body's volume in a leaf, or, if there is a second body, what the two exchange there.
struct Share {
  BodyId body, other;
  double value = 0;
  bool at_contact = false;  ///< whether it is exchanged in a leaf with more than one interface
};

/// Returns the body that surely owns the whole cell as long as no function changes by more than `reach`; an
/// invalid one if there is none.
BodyId sole_owner(const OwnershipProblem& problem, double reach) {
  double surely = -kInfinity, next = -kInfinity;
  BodyId owner;
  const auto bounds = [&](const OwnershipProblem::Candidate& candidate) {
    double least = kInfinity, most = kInfinity;
    for (std::uint32_t f = 0; f < candidate.count; ++f) {
      const auto& v = problem.functions[candidate.first + f].values;
      least = std::min(least, std::min({v[0], v[1], v[2], v[3]}));
      most = std::min(most, std::max({v[0], v[1], v[2], v[3]}));
    }
    return std::pair(least, most);
  };
  for (const auto& candidate : problem.candidates) {
    const double least = bounds(candidate).first;
    if (least > surely) surely = least, owner = BodyId(candidate.owner);
  }
  for (const auto& candidate : problem.candidates) {
    if (BodyId(candidate.owner) != owner) next = std::max(next, bounds(candidate).second);
  }
  return surely - next > 2 * reach ? owner : BodyId();
}

/// Returns the least of a candidate's functions at a point, which determines what the candidate owns there.
const LinearFunction& binding(const OwnershipProblem& problem, std::uint32_t owner, const Weights& at) {
  const auto candidate =
      std::find_if(problem.candidates.begin(), problem.candidates.end(),
                   [owner](const OwnershipProblem::Candidate& c) { return c.owner == owner; });
  const auto value = [&](const LinearFunction& f) {
    return f.values[0] * at[0] + f.values[1] * at[1] + f.values[2] * at[2] + f.values[3] * at[3];
  };
  const auto first = problem.functions.begin() + candidate->first;
  return *std::min_element(first, first + candidate->count,
                           [&](const auto& f, const auto& g) { return value(f) < value(g); });
}

/// A polygon between two owners in a cell.
struct ContactShape {
  Vec3 area;       ///< along the normal
  Weights middle;  ///< the mean of the corners
};

ContactShape shape_of(const Tetrahedron& cell, const ContactPolygon& contact) {
  ContactShape shape{};
  const Vec3 origin = cell.point(contact.corners[0].weights);
  Vec3 last = origin;
  for (const ContactPolygon::Corner& corner : contact.corners) {
    const Vec3 p = cell.point(corner.weights);
    shape.area += 0.5 * cross(last - origin, p - origin);
    last = p;
    for (std::size_t v = 0; v < 4; ++v)
      shape.middle[v] += corner.weights[v] / static_cast<double>(contact.corners.size());
  }
  return shape;
}

/// Returns the derivative of the volume exchanged at a contact with respect to the difference of the two
/// bodies' functions: the area divided by the slope of that difference.
double exchanged(const Tetrahedron& cell, const OwnershipProblem& problem, const ContactPolygon& contact,
                 const ContactShape& shape) {
  std::array<double, 4> difference{};
  const auto &front = binding(problem, contact.front, shape.middle),
             &back = binding(problem, contact.back, shape.middle);
  for (std::size_t v = 0; v < 4; ++v) difference[v] = front.values[v] - back.values[v];
  const double slope = norm(cell.gradient(difference));
  return slope > 0 ? norm(shape.area) / slope : 0;
}

/// Drops functions that are at no vertex less than another one of their candidate.
void drop_greater_functions(OwnershipProblem& problem) {
  if (problem.functions.size() == problem.candidates.size()) return;
  const auto is_greater = [&](std::uint32_t f, std::uint32_t than) {
    bool equal = true;
    for (std::size_t v = 0; v < 4; ++v) {
      const double a = problem.functions[f].values[v], b = problem.functions[than].values[v];
      if (a < b) return false;
      equal = equal && a == b;
    }
    return !equal || f > than;
  };
  std::vector<LinearFunction> kept;
  for (auto& candidate : problem.candidates) {
    const auto first = static_cast<std::uint32_t>(kept.size());
    const std::uint32_t end = candidate.first + candidate.count;
    for (std::uint32_t f = candidate.first; f < end; ++f) {
      bool dropped = false;
      for (std::uint32_t g = candidate.first; g < end && !dropped; ++g) dropped = f != g && is_greater(f, g);
      if (!dropped) kept.push_back(problem.functions[f]);
    }
    candidate.first = first;
    candidate.count = static_cast<std::uint32_t>(kept.size()) - first;
  }
  problem.functions.swap(kept);
}

/// Finds the volumes of bodies in leaves. Its memory is reused for the next leaf.
class VolumeFinder {
 public:
  /// `contacts`: whether exchanges in leaves with more than one interface are wanted.
  VolumeFinder(const ResamplingState& state, const IdVector<VertexId, double>& gains, bool contacts = true)
      : state_(state), gains_(gains), with_contacts_(contacts) {}

  /// Adds the volumes in a leaf, and what is exchanged in it.
  void find(TetrahedronId leaf, std::vector<Share>& shares) {
    state_.ownership(leaf, owners_);
    OwnershipProblem& problem = owners_.problem;
    if (problem.candidates.size() > 2) drop_dominated(problem);
    drop_greater_functions(problem);
    const double volume = state_.volume(leaf);
    if (problem.candidates.size() == 1) {
      shares.push_back({BodyId(problem.candidates[0].owner), {}, volume});
      return;
    }
    if (problem.candidates.size() == 2 && problem.candidates[0].count == 1 &&
        problem.candidates[1].count == 1) {
      share_between_two(leaf, volume, shares);
      return;
    }
    parts_.clear();
    partition_tetrahedron(problem, parts_);
    for (const OwnedTetrahedron& part : parts_)
      shares.push_back({BodyId(part.owner), {}, volume * volume_fraction(part.corners)});
    if (with_contacts_) share_at_contacts(leaf, shares);
  }

 private:
  void share_between_two(TetrahedronId leaf, double volume, std::vector<Share>& shares) const {
    const OwnershipProblem& problem = owners_.problem;
    const auto &first = problem.candidates[0], &second = problem.candidates[1];
    std::array<double, 4> difference{};
    for (std::size_t v = 0; v < 4; ++v)
      difference[v] = problem.functions[first.first].values[v] - problem.functions[second.first].values[v];
    const PositivePart part = positive_part(difference);
    const BodyId a(first.owner), b(second.owner);
    shares.push_back({a, {}, volume * part.volume});
    shares.push_back({b, {}, volume * (1 - part.volume)});
    const auto vertices = state_.hierarchy.vertices(leaf);
    double by = 0;
    for (std::size_t v = 0; v < 4; ++v) by += gains_[vertices[v]] * part.growth[v];
    if (by > 0) shares.push_back({std::min(a, b), std::max(a, b), volume * by});
  }

  void share_at_contacts(TetrahedronId leaf, std::vector<Share>& shares) {
    const auto vertices = state_.hierarchy.vertices(leaf);
    if (std::ranges::none_of(vertices, [&](VertexId v) { return gains_[v] > 0; })) return;
    contacts_.clear();
    contact_polygons(owners_.problem, contacts_);
    const Tetrahedron cell = state_.frame(leaf);
    for (const ContactPolygon& contact : contacts_) {
      const ContactShape shape = shape_of(cell, contact);
      double gain = 0;
      for (std::size_t v = 0; v < 4; ++v) gain += gains_[vertices[v]] * shape.middle[v];
      const auto [a, b] = std::minmax(contact.front, contact.back);
      const double by = gain * exchanged(cell, owners_.problem, contact, shape);
      if (by > 0) shares.push_back({BodyId(a), BodyId(b), by, true});
    }
  }

  const ResamplingState& state_;
  const IdVector<VertexId, double>& gains_;
  bool with_contacts_;
  CellOwnership owners_;
  std::vector<OwnedTetrahedron> parts_;
  std::vector<ContactPolygon> contacts_;
};

/// Adds up exchanges of pairs of bodies.
class ExchangeSums {
 public:
  explicit ExchangeSums(const InterfaceTable& table) : table_(table), sums_(table.interface_count(), 0.0) {}

  void add(BodyId a, BodyId b, double by) {
    if (const auto interface = table_.find(a, b)) {
      sums_[*interface] += by;
    } else {
      others_[{a, b}] += by;
    }
  }
  [[nodiscard]] std::vector<Exchange> all() const {
    std::vector<Exchange> result;
    for (InterfaceId i(0); i.value < sums_.size(); ++i.value) {
      if (sums_[i] > 0) result.emplace_back(table_.sides(i), sums_[i]);
    }
    for (const auto& [pair, sum] : others_) {
      if (sum > 0) result.emplace_back(pair, sum);
    }
    std::ranges::sort(result, {}, &Exchange::first);
    return result;
  }

 private:
  const InterfaceTable& table_;
  IdVector<InterfaceId, double> sums_;
  std::map<std::array<BodyId, 2>, double> others_;  ///< of bodies that touch in the mesh alone
};

}  // namespace

LeavesNearInterfaces::LeavesNearInterfaces(const ResamplingState& state, double reach)
    : state_(state), elsewhere_(state.source.network->table().body_count(), 0.0) {
  const std::vector<TetrahedronId> all = state.leaves();
  std::vector<BodyId> owner(all.size());
  parallel_chunks(all.size(), 2048, [&](std::size_t begin, std::size_t end) {
    CellOwnership owners;
    for (std::size_t i = begin; i < end; ++i) {
      state.ownership(all[i], owners, {.reach = 2 * reach});
      owner[i] =
          owners.pure() ? BodyId(owners.problem.candidates[0].owner) : sole_owner(owners.problem, reach);
    }
  });
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (owner[i].valid()) {
      elsewhere_[owner[i]] += state.volume(all[i]);
    } else {
      leaves_.push_back(all[i]);
    }
  }
}

ExchangedVolumes LeavesNearInterfaces::measure(const IdVector<VertexId, double>& gains,
                                               std::optional<std::vector<Exchange>>& at_contacts) const {
  const auto shares = parallel_collect<Share>(
      leaves_.size(), 256, [&](std::size_t first, std::size_t last, std::vector<Share>& list) {
        VolumeFinder finder(state_, gains, !at_contacts);
        for (std::size_t i = first; i < last; ++i) finder.find(leaves_[i], list);
      });
  ExchangedVolumes result{elsewhere_, {}};
  ExchangeSums sums(state_.source.network->table()), found(state_.source.network->table());
  for (const Share& share : shares) {
    if (share.other.valid()) {
      (share.at_contact ? found : sums).add(share.body, share.other, share.value);
    } else {
      result.volumes[share.body] += share.value;
    }
  }
  if (!at_contacts) at_contacts = found.all();
  for (const auto& [pair, by] : *at_contacts) sums.add(pair[0], pair[1], by);
  result.exchanges = sums.all();
  return result;
}

std::vector<std::vector<BodyId>> LeavesNearInterfaces::owners(const IdVector<BodyId, char>& bodies) const {
  const IdVector<VertexId, double> gains(state_.hierarchy.vertex_slots(), 0.0);
  std::vector<std::vector<BodyId>> result(leaves_.size());
  parallel_chunks(leaves_.size(), 256, [&](std::size_t first, std::size_t last) {
    VolumeFinder finder(state_, gains);
    std::vector<Share> shares;
    for (std::size_t i = first; i < last; ++i) {
      shares.clear();
      finder.find(leaves_[i], shares);
      for (const Share& share : shares) {
        if (bodies[share.body] != 0 && share.value > 0) result[i].push_back(share.body);
      }
      sort_unique(result[i]);
    }
  });
  return result;
}

void LeavesNearInterfaces::keep_those_at(const IdVector<VertexId, char>& vertices) {
  const IdVector<VertexId, double> gains(vertices.size(), 0.0);
  VolumeFinder finder(state_, gains);
  std::vector<Share> shares;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    if (std::ranges::any_of(state_.hierarchy.vertices(leaves_[i]),
                            [&](VertexId v) { return vertices[v] != 0; })) {
      leaves_[kept++] = leaves_[i];
    } else {
      finder.find(leaves_[i], shares);
    }
  }
  leaves_.resize(kept);
  for (const Share& share : shares) {
    if (!share.other.valid()) elsewhere_[share.body] += share.value;
  }
}

std::vector<std::pair<std::array<BodyId, 2>, TetrahedronId>> LeavesNearInterfaces::exchanging_leaves() const {
  using Result = std::pair<std::array<BodyId, 2>, TetrahedronId>;
  const IdVector<VertexId, double> gains(state_.hierarchy.vertex_slots(), 1.0);
  return parallel_collect<Result>(leaves_.size(), 256, [&](std::size_t first, std::size_t last, auto& list) {
    VolumeFinder finder(state_, gains);
    std::vector<Share> shares;
    for (std::size_t i = first; i < last; ++i) {
      shares.clear();
      finder.find(leaves_[i], shares);
      for (const Share& share : shares) {
        const Result found{{share.body, share.other}, leaves_[i]};
        if (share.other.valid() && (list.empty() || list.back() != found)) list.push_back(found);
      }
    }
  });
}

}  // namespace adamas::interfaces
