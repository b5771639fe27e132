#include "interfaces/ownership/cell_ownership.h"

#include <algorithm>

namespace adamas {

namespace {

constexpr std::uint64_t kLonelyKey = std::uint64_t{1} << 63;

/// A body the cell knows: is it within reach of each vertex, and its functions.
struct KnownBody {
  BodyId body;
  std::array<bool, 4> within{};
  std::vector<std::uint64_t> keys;
  std::vector<std::array<double, 4>> functions;
};

KnownBody& entry(std::vector<KnownBody>& known, BodyId body) {
  return *std::lower_bound(known.begin(), known.end(), body,
                           [](const KnownBody& k, BodyId b) { return k.body < b; });
}

std::vector<KnownBody> known_bodies(const InterfaceTable& table,
                                    const std::array<const VertexDistances*, 4>& vertices) {
  std::vector<BodyId> bodies;
  for (const VertexDistances* v : vertices) {
    bodies.push_back(v->body);
    for (const NearDistance& near : v->near) {
      bodies.insert(bodies.end(), table.sides(near.interface).begin(), table.sides(near.interface).end());
    }
  }
  std::sort(bodies.begin(), bodies.end());
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  std::vector<KnownBody> known(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) known[i].body = bodies[i];
  for (std::size_t v = 0; v < 4; ++v) {
    entry(known, vertices[v]->body).within[v] = true;
    for (const NearDistance& near : vertices[v]->near) {
      for (const BodyId side : table.sides(near.interface)) entry(known, side).within[v] = true;
    }
  }
  return known;
}

}  // namespace

std::size_t CellOwnership::candidate(BodyId body) const {
  const auto& list = problem.candidates;
  const auto found =
      std::lower_bound(list.begin(), list.end(), body.value,
                       [](const auto& candidate, std::uint32_t owner) { return candidate.owner < owner; });
  return found != list.end() && found->owner == body.value ? static_cast<std::size_t>(found - list.begin())
                                                           : list.size();
}

void find_cell_ownership(const InterfaceTable& table, const std::array<const VertexDistances*, 4>& vertices,
                         CellOwnership& ownership) {
  ownership.problem.clear();
  ownership.interfaces.clear();
  const bool alone = std::all_of(vertices.begin(), vertices.end(), [&](const VertexDistances* v) {
    return v->near.empty() && v->body == vertices[0]->body;
  });
  if (alone) {
    ownership.problem.add_candidate(vertices[0]->body.value);
    return;
  }
  std::vector<KnownBody> known = known_bodies(table, vertices);
  struct Found {
    InterfaceId id;
    std::size_t first, second;
  };
  std::vector<Found> found;
  for (std::size_t a = 0; a < known.size(); ++a) {
    const auto& neighbours = table.neighbours(known[a].body);
    if (neighbours.size() < known.size()) {
      for (const auto& [other, id] : neighbours) {
        if (!(known[a].body < other)) continue;
        const auto at = std::lower_bound(known.begin(), known.end(), other,
                                         [](const KnownBody& k, BodyId b) { return k.body < b; });
        if (at != known.end() && at->body == other)
          found.push_back({id, a, static_cast<std::size_t>(at - known.begin())});
      }
      continue;
    }
    for (std::size_t b = a + 1; b < known.size(); ++b) {
      if (const auto id = table.find(known[a].body, known[b].body)) found.push_back({*id, a, b});
    }
  }
  std::sort(found.begin(), found.end(), [](const Found& x, const Found& y) { return x.id < y.id; });
  for (const Found& f : found) {
    std::array<double, 4> first{}, second{};
    for (std::size_t v = 0; v < 4; ++v) {
      const auto& near = vertices[v]->near;
      const auto at = std::lower_bound(near.begin(), near.end(), f.id,
                                       [](const NearDistance& n, InterfaceId i) { return n.interface < i; });
      // Far from the interface: a value that no other exceeds, or falls below where the body itself is far.
      const auto far_value = [&](const KnownBody& body) {
        return body.within[v] ? vertices[v]->radius : -vertices[v]->radius;
      };
      const bool is_near = at != near.end() && at->interface == f.id;
      first[v] = is_near ? at->distance : far_value(known[f.first]);
      second[v] = is_near ? -at->distance : far_value(known[f.second]);
    }
    ownership.interfaces.push_back({f.id, static_cast<std::uint32_t>(known[f.first].functions.size()),
                                    static_cast<std::uint32_t>(known[f.second].functions.size())});
    known[f.first].functions.push_back(first);
    known[f.first].keys.push_back(2 * std::uint64_t{f.id.value});
    known[f.second].functions.push_back(second);
    known[f.second].keys.push_back(2 * std::uint64_t{f.id.value} + 1);
  }
  for (const KnownBody& body : known) {
    ownership.problem.add_candidate(body.body.value);
    for (std::size_t f = 0; f < body.functions.size(); ++f)
      ownership.problem.add_function(body.functions[f], body.keys[f]);
    if (!body.functions.empty() || known.size() == 1) continue;
    // No interface with another known body: it owns only what is nearest to the vertices inside it.
    std::array<double, 4> values{};
    for (std::size_t v = 0; v < 4; ++v)
      values[v] = vertices[v]->body == body.body ? vertices[v]->radius : -vertices[v]->radius;
    ownership.problem.add_function(values, kLonelyKey + body.body.value);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    ownership.interfaces[i].towards_first += ownership.problem.candidates[found[i].first].first;
    ownership.interfaces[i].towards_second += ownership.problem.candidates[found[i].second].first;
  }
}

}  // namespace adamas
