#include "interfaces/ownership/cell_ownership.h"

#include <algorithm>
#include <limits>

#include "core/base/sort_unique.h"

namespace adamas::interfaces {

namespace {

constexpr std::uint64_t kLonelyKey = std::uint64_t{1} << 63;

/// What the vertices of a cell know. Its memory is reused for the next cell.
class Knowledge {
 public:
  /// Sets what the vertices know; `table` is that of their interfaces.
  void find(const InterfaceTable& table, const std::array<const VertexDistances*, 4>& vertices,
            const OwnershipNeeds& needs) {
    if (positions_.size() < table.body_count()) positions_.resize(table.body_count(), 0);
    for (std::size_t v = 0; v < 4; ++v) radii_[v] = vertices[v]->radius;
    near_.clear();
    bodies_.clear();
    for (std::size_t v = 0; v < 4; ++v)
      bodies_[position(vertices[v]->body)].within |= static_cast<std::uint8_t>(1u << v);
    merge_near(table, vertices);
    add_far(table, needs.interfaces);
    find_ceilings();
    mark_needed(needs);
  }

  /// Sets `ownership` to the needed bodies, in the order of their ids.
  void give(const InterfaceTable& table, CellOwnership& ownership) {
    order_.clear();
    for (std::uint32_t b = 0; b < bodies_.size(); ++b) {
      if (bodies_[b].is_needed) order_.push_back(b);
    }
    std::ranges::sort(order_, {}, [&](std::uint32_t b) { return bodies_[b].id; });
    OwnershipProblem& problem = ownership.problem;
    for (const std::uint32_t b : order_) {
      Body& body = bodies_[b];
      problem.add_candidate(body.id.value);
      body.next = problem.candidates.back().first;
      if (body.interfaces == 0) {
        give_remote(table, body, problem);
      } else {
        problem.functions.resize(body.next + body.interfaces);
        problem.candidates.back().count = body.interfaces;
      }
    }
    for (const Near& near : near_) {
      const bool first = bodies_[near.sides[0]].is_needed, second = bodies_[near.sides[1]].is_needed;
      if (first && second)
        ownership.interfaces.push_back({near.id, bodies_[near.sides[0]].next, bodies_[near.sides[1]].next});
      for (std::size_t side = 0; side < 2; ++side) {
        Body& body = bodies_[near.sides[side]];
        if (body.is_needed)
          problem.functions[body.next++] = {values(near, side), 2 * std::uint64_t{near.id.value} + side};
      }
    }
  }

 private:
  /// An interface that is near a vertex, or is needed.
  struct Near {
    InterfaceId id;
    std::array<std::uint32_t, 2> sides;  ///< the positions of its bodies
    std::uint8_t near = 0;               ///< bit v is set if it is near vertex v
    std::array<double, 4> distances{};
  };
  /// A body that a vertex knows: it lies in it, or an interface of it is near.
  struct Body {
    BodyId id;
    std::array<double, 4> least;   ///< its value at the vertices that know it
    double ceiling;                ///< it is nowhere greater
    std::uint32_t interfaces = 0;  ///< the number of its interfaces that are near a vertex
    std::uint32_t next = 0;        ///< the place of its next function in the problem
    std::uint8_t within = 0;       ///< bit v is set if vertex v knows it
    bool is_needed = false;
    [[nodiscard]] bool is_within(std::size_t v) const { return (within >> v & 1u) != 0u; }
  };

  [[nodiscard]] bool is_at(std::uint32_t position, BodyId id) const {
    return position < bodies_.size() && bodies_[position].id == id;
  }
  /// Returns the position of a body, which is added if it is new.
  std::uint32_t position(BodyId id) {
    if (is_at(positions_[id.value], id)) return positions_[id.value];
    positions_[id.value] = static_cast<std::uint32_t>(bodies_.size());
    bodies_.push_back({id, radii_, *std::ranges::max_element(radii_)});
    return positions_[id.value];
  }

  /// Adds the interfaces near the vertices, ascending as those of each vertex do.
  void merge_near(const InterfaceTable& table, const std::array<const VertexDistances*, 4>& vertices) {
    std::array<const NearDistance*, 4> next{}, last{};
    for (std::size_t v = 0; v < 4; ++v) {
      next[v] = vertices[v]->near.data();
      last[v] = next[v] + vertices[v]->near.size();
    }
    while (true) {
      InterfaceId least;
      for (std::size_t v = 0; v < 4; ++v) {
        if (next[v] != last[v] && (!least.valid() || next[v]->interface < least)) least = next[v]->interface;
      }
      if (!least.valid()) return;
      const auto& [a, b] = table.sides(least);
      Near found{least, {position(a), position(b)}};
      for (std::size_t v = 0; v < 4; ++v) {
        if (next[v] == last[v] || next[v]->interface != least) continue;
        found.near = static_cast<std::uint8_t>(found.near | 1u << v);
        found.distances[v] = next[v]->distance;
        ++next[v];
      }
      add(found);
    }
  }

  /// Adds those of these interfaces that are near no vertex, but whose bodies vertices know.
  void add_far(const InterfaceTable& table, std::span<const InterfaceId> interfaces) {
    for (const InterfaceId id : interfaces) {
      const auto place = std::ranges::lower_bound(near_, id, {}, &Near::id);
      if (place != near_.end() && place->id == id) continue;
      const auto& [a, b] = table.sides(id);
      const std::uint32_t first = positions_[a.value], second = positions_[b.value];
      if (!is_at(first, a) || !is_at(second, b)) continue;
      near_.insert(place, Near{id, {first, second}});
      ++bodies_[first].interfaces, ++bodies_[second].interfaces;
    }
  }

  void add(const Near& near) {
    near_.push_back(near);
    for (std::size_t side = 0; side < 2; ++side) {
      Body& body = bodies_[near.sides[side]];
      ++body.interfaces;
      body.within |= near.near;
      for (std::size_t v = 0; v < 4; ++v) {
        if ((near.near >> v & 1u) != 0u)
          body.least[v] = std::min(body.least[v], side == 0 ? near.distances[v] : -near.distances[v]);
      }
    }
  }

  /// A body is nowhere greater than the greatest value of any of its functions.
  void find_ceilings() {
    for (const Near& near : near_) {
      for (std::size_t side = 0; side < 2; ++side) {
        Body& body = bodies_[near.sides[side]];
        body.ceiling = std::min(body.ceiling, std::ranges::max(values(near, side)));
      }
    }
  }

  /// Marks the bodies that may own a part of the cell, and those that are needed besides.
  void mark_needed(const OwnershipNeeds& needs) {
    double surely = -std::numeric_limits<double>::infinity();
    for (const Body& body : bodies_) {
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t v = 0; v < 4; ++v)
        least = std::min(least, body.is_within(v) ? body.least[v] : -radii_[v]);
      surely = std::max(surely, least);
    }
    for (Body& body : bodies_)
      body.is_needed =
          !(body.ceiling < surely - needs.reach) || std::ranges::binary_search(needs.bodies, body.id);
    for (const InterfaceId id : needs.interfaces) {
      const auto found = std::ranges::lower_bound(near_, id, {}, &Near::id);
      if (found == near_.end() || found->id != id) continue;
      for (const std::uint32_t side : found->sides) bodies_[side].is_needed = true;
    }
  }

  /// Returns the values of an interface's function towards one of its bodies. Far from the interface, they
  /// are greater than all others, or less if the body itself is far.
  [[nodiscard]] std::array<double, 4> values(const Near& near, std::size_t side) const {
    const Body& body = bodies_[near.sides[side]];
    std::array<double, 4> result;
    for (std::size_t v = 0; v < 4; ++v) {
      const double distance = side == 0 ? near.distances[v] : -near.distances[v];
      result[v] = (near.near >> v & 1u) != 0u ? distance : far_value(body, v);
    }
    return result;
  }
  [[nodiscard]] double far_value(const Body& body, std::size_t v) const {
    return body.is_within(v) ? radii_[v] : -radii_[v];
  }

  /// Adds the functions of a body in which vertices lie that are near no interface of it: one for each
  /// interface with another known body. Without such an interface it owns only the region nearest to these
  /// vertices.
  void give_remote(const InterfaceTable& table, const Body& body, OwnershipProblem& problem) const {
    std::array<double, 4> far;
    for (std::size_t v = 0; v < 4; ++v) far[v] = far_value(body, v);
    std::vector<InterfaceId> interfaces;
    for (const Body& other : bodies_) {
      if (const auto id = table.find(body.id, other.id)) interfaces.push_back(*id);
    }
    std::ranges::sort(interfaces);
    for (const InterfaceId id : interfaces)
      problem.add_function(far, 2 * std::uint64_t{id.value} + (table.sides(id)[0] == body.id ? 0 : 1));
    if (interfaces.empty()) problem.add_function(far, kLonelyKey + body.id.value);
  }

  std::array<double, 4> radii_{};
  std::vector<Near> near_;
  std::vector<Body> bodies_;              ///< in the order in which they are found
  std::vector<std::uint32_t> positions_;  ///< by body: its position in `bodies_`, if that has this body
  std::vector<std::uint32_t> order_;
};

}  // namespace

void list_known_bodies(const InterfaceTable& table, VertexDistances& vertex) {
  auto& bodies = vertex.bodies;
  bodies.assign(1, vertex.body);
  for (const NearDistance& near : vertex.near) {
    const auto& sides = table.sides(near.interface);
    bodies.insert(bodies.end(), sides.begin(), sides.end());
  }
  sort_unique(bodies);
  bodies.shrink_to_fit();
}

std::size_t CellOwnership::candidate(BodyId body) const {
  const auto& list = problem.candidates;
  const auto found =
      std::lower_bound(list.begin(), list.end(), body.value,
                       [](const auto& candidate, std::uint32_t owner) { return candidate.owner < owner; });
  return found != list.end() && found->owner == body.value ? static_cast<std::size_t>(found - list.begin())
                                                           : list.size();
}

void partition_cell(CellOwnership& ownership, std::vector<OwnedTetrahedron>& parts) {
  parts.clear();
  if (ownership.pure()) {
    parts.push_back({ownership.problem.candidates[0].owner, kVertexWeights});
    return;
  }
  drop_dominated(ownership.problem);
  partition_tetrahedron(ownership.problem, parts);
}

void find_cell_ownership(const InterfaceTable& table, const std::array<const VertexDistances*, 4>& vertices,
                         CellOwnership& ownership, const OwnershipNeeds& needs) {
  OwnershipProblem& problem = ownership.problem;
  problem.clear();
  ownership.interfaces.clear();
  const bool alone = std::all_of(vertices.begin(), vertices.end(), [&](const VertexDistances* v) {
    return v->near.empty() && v->body == vertices[0]->body;
  });
  if (alone) {
    problem.add_candidate(vertices[0]->body.value);
    return;
  }
  thread_local Knowledge known;
  known.find(table, vertices, needs);
  known.give(table, ownership);
}

}  // namespace adamas::interfaces
