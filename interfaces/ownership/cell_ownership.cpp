#include "interfaces/ownership/cell_ownership.h"

#include <algorithm>

#include "core/base/sort_unique.h"

namespace adamas::interfaces {

namespace {

constexpr std::uint64_t kLonelyKey = std::uint64_t{1} << 63;

/// The distances that the vertices of a cell know. Its memory is reused for the next cell.
struct Knowledge {
  struct Found {
    InterfaceId id;
    std::uint32_t first, second;  ///< the positions of its bodies
  };
  std::vector<BodyId> bodies;         ///< ascending
  std::vector<std::uint8_t> within;   ///< by body: bit v is set if vertex v knows the body
  std::vector<std::uint32_t> counts;  ///< by body: the number of interfaces with other known bodies
  std::vector<Found> found;           ///< by id
  /// By body of the table: its position in `bodies`, if that position has this body.
  std::vector<std::uint32_t> positions;

  /// Returns the position of a body; the number of known bodies if it is not known.
  [[nodiscard]] std::size_t position(BodyId body) const {
    const std::uint32_t at = positions[body.value];
    return at < bodies.size() && bodies[at] == body ? at : bodies.size();
  }

  void merge_bodies(const std::array<const VertexDistances*, 4>& vertices) {
    bodies.clear();
    within.clear();
    std::array<std::vector<BodyId>::const_iterator, 4> next;
    for (std::size_t v = 0; v < 4; ++v) next[v] = vertices[v]->bodies.begin();
    while (true) {
      BodyId least;
      for (std::size_t v = 0; v < 4; ++v) {
        if (next[v] != vertices[v]->bodies.end() && (!least.valid() || *next[v] < least)) least = *next[v];
      }
      if (!least.valid()) return;
      unsigned bits = 0;
      for (std::size_t v = 0; v < 4; ++v) {
        if (next[v] == vertices[v]->bodies.end() || *next[v] != least) continue;
        bits |= 1u << v;
        ++next[v];
      }
      bodies.push_back(least);
      within.push_back(static_cast<std::uint8_t>(bits));
    }
  }

  void find_interfaces(const InterfaceTable& table) {
    found.clear();
    counts.assign(bodies.size(), 0);
    if (positions.size() < table.body_count()) positions.resize(table.body_count(), 0);
    for (std::uint32_t i = 0; i < bodies.size(); ++i) positions[bodies[i].value] = i;
    const auto add = [&](InterfaceId id, std::size_t a, std::size_t b) {
      found.push_back({id, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
      ++counts[a];
      ++counts[b];
    };
    for (std::size_t a = 0; a < bodies.size(); ++a) {
      const auto& neighbours = table.neighbours(bodies[a]);
      if (neighbours.size() < bodies.size()) {
        const auto after = std::pair(bodies[a], InterfaceId());
        for (auto n = std::upper_bound(neighbours.begin(), neighbours.end(), after); n != neighbours.end();
             ++n) {
          const std::size_t b = position(n->first);
          if (b < bodies.size()) add(n->second, a, b);
        }
        continue;
      }
      for (std::size_t b = a + 1; b < bodies.size(); ++b) {
        if (const auto id = table.find(bodies[a], bodies[b])) add(*id, a, b);
      }
    }
    // Interfaces that are numbered in the order of their bodies are found in order.
    if (!std::ranges::is_sorted(found, {}, &Found::id)) std::ranges::sort(found, {}, &Found::id);
  }
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
  constexpr std::array<Weights, 4> kWhole{Weights{1, 0, 0, 0}, Weights{0, 1, 0, 0}, Weights{0, 0, 1, 0},
                                          Weights{0, 0, 0, 1}};
  parts.clear();
  if (ownership.pure()) {
    parts.push_back({ownership.problem.candidates[0].owner, kWhole});
    return;
  }
  drop_dominated(ownership.problem);
  partition_tetrahedron(ownership.problem, parts);
}

void find_cell_ownership(const InterfaceTable& table, const std::array<const VertexDistances*, 4>& vertices,
                         CellOwnership& ownership) {
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
  known.merge_bodies(vertices);
  known.find_interfaces(table);
  for (std::size_t b = 0, first = 0; b < known.bodies.size(); ++b) {
    // A body without an interface with another known body owns only the region nearest to the vertices inside
    // it.
    const std::uint32_t functions = std::max(known.counts[b], 1u);
    problem.candidates.push_back({known.bodies[b].value, static_cast<std::uint32_t>(first), functions});
    problem.functions.resize(first + functions);
    if (known.counts[b] == 0) {
      LinearFunction& lonely = problem.functions[first];
      lonely.key = kLonelyKey + known.bodies[b].value;
      for (std::size_t v = 0; v < 4; ++v) {
        lonely.values[v] = vertices[v]->body == known.bodies[b] ? vertices[v]->radius : -vertices[v]->radius;
      }
    }
    first += functions;
    known.counts[b] = 0;  // from here on, the number of functions filled in
  }
  // The interfaces near a vertex ascend as those of the cell do.
  std::array<const NearDistance*, 4> next{}, last{};
  for (std::size_t v = 0; v < 4; ++v) {
    next[v] = vertices[v]->near.data();
    last[v] = next[v] + vertices[v]->near.size();
  }
  for (const Knowledge::Found& f : known.found) {
    const std::uint32_t towards_first = problem.candidates[f.first].first + known.counts[f.first]++;
    const std::uint32_t towards_second = problem.candidates[f.second].first + known.counts[f.second]++;
    ownership.interfaces.push_back({f.id, towards_first, towards_second});
    LinearFunction &first = problem.functions[towards_first], &second = problem.functions[towards_second];
    first.key = 2 * std::uint64_t{f.id.value};
    second.key = first.key + 1;
    for (std::size_t v = 0; v < 4; ++v) {
      while (next[v] != last[v] && next[v]->interface < f.id) ++next[v];
      // Far from the interface, the value is greater than all others, or less if the body itself is far.
      const auto far_value = [&](std::uint32_t body) {
        return (known.within[body] >> v & 1u) != 0u ? vertices[v]->radius : -vertices[v]->radius;
      };
      const bool is_near = next[v] != last[v] && next[v]->interface == f.id;
      first.values[v] = is_near ? next[v]->distance : far_value(f.first);
      second.values[v] = is_near ? -next[v]->distance : far_value(f.second);
    }
  }
}

}  // namespace adamas::interfaces
