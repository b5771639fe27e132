#include "interfaces/ownership/cell_ownership.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/network/interface_network.h"
#include "tests/interfaces/network_meshes.h"
#include "tests/support/ownership_problems.h"

namespace adamas {

using namespace interfaces;
using namespace datasets;

namespace {

/// The values of all bodies that the vertices of a cell know, straight from the definition: a body is the
/// least of the functions of its interfaces with other known bodies.
class AllBodies {
 public:
  AllBodies(const InterfaceTable& table, const std::array<VertexDistances, 4>& vertices) : table_(table) {
    std::array<std::set<BodyId>, 4> within;
    for (std::size_t v = 0; v < 4; ++v) {
      within[v].insert(vertices[v].body);
      for (const NearDistance& near : vertices[v].near) {
        for (const BodyId body : table.sides(near.interface)) within[v].insert(body);
      }
      known_.insert(within[v].begin(), within[v].end());
    }
    for (InterfaceId id(0); id.value < table.interface_count(); ++id.value) {
      const auto& sides = table.sides(id);
      if (!known_.contains(sides[0]) || !known_.contains(sides[1])) continue;
      for (std::size_t side = 0; side < 2; ++side) {
        std::array<double, 4> values{};
        for (std::size_t v = 0; v < 4; ++v) {
          const auto near = std::ranges::find(vertices[v].near, id, &NearDistance::interface);
          values[v] = near != vertices[v].near.end()    ? (side == 0 ? near->distance : -near->distance)
                      : within[v].contains(sides[side]) ? vertices[v].radius
                                                        : -vertices[v].radius;
        }
        functions_[sides[side]][id] = values;
      }
    }
    for (const BodyId body : known_) {
      std::array<double, 4> lonely{};
      for (std::size_t v = 0; v < 4; ++v)
        lonely[v] = vertices[v].body == body ? vertices[v].radius : -vertices[v].radius;
      if (functions_[body].empty()) functions_[body][InterfaceId()] = lonely;
    }
  }

  [[nodiscard]] const std::set<BodyId>& known() const { return known_; }
  [[nodiscard]] const std::map<InterfaceId, std::array<double, 4>>& functions(BodyId body) const {
    return functions_.at(body);
  }
  [[nodiscard]] double value(BodyId body, const Weights& at) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [id, values] : functions_.at(body)) {
      double value = 0;
      for (std::size_t v = 0; v < 4; ++v) value += at[v] * values[v];
      least = std::min(least, value);
    }
    return least;
  }

 private:
  const InterfaceTable& table_;
  std::set<BodyId> known_;
  std::map<BodyId, std::map<InterfaceId, std::array<double, 4>>> functions_;
};

/// The knowledge of the vertices of a random tetrahedron in the unit cube, about `size` large. R is up to
/// three times its diameter, so that vertices know many bodies.
std::array<VertexDistances, 4> random_cell(const InterfaceNetwork& network, double size,
                                           std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const Vec3 origin{unit(random), unit(random), unit(random)};
  std::array<VertexDistances, 4> vertices;
  for (VertexDistances& vertex : vertices) {
    const Vec3 p = origin + size * Vec3{unit(random), unit(random), unit(random)};
    vertex.radius = std::sqrt(3.0) * size * (1 + 2 * unit(random));
    vertex.body = network.body_at(p);
    std::vector<NearInterface> near;
    network.near_interfaces(p, vertex.radius, vertex.body, near);
    for (const NearInterface& n : near) vertex.near.push_back({n.interface, n.signed_distance});
  }
  return vertices;
}

/// Calls visit(network, vertices, random) for random cells of scenes with many bodies.
template <class Visit>
void for_each_random_cell(const Visit& visit) {
  for (const char* name : {"voronoi10", "shell3", "random"}) {
    const InterfaceNetwork network(scene_interfaces(make_scene(name), 0.1), test::unit_box());
    std::mt19937_64 random(7);
    for (int cell = 0; cell < 200; ++cell) {
      const double size =
          std::exp(std::uniform_real_distribution<double>(std::log(0.01), std::log(0.3))(random));
      visit(network, random_cell(network, size, random), random);
    }
  }
}

CellOwnership ownership_of(const InterfaceNetwork& network, const std::array<VertexDistances, 4>& vertices,
                           const OwnershipNeeds& needs) {
  CellOwnership ownership;
  find_cell_ownership(network.table(), {&vertices[0], &vertices[1], &vertices[2], &vertices[3]}, ownership,
                      needs);
  return ownership;
}

TEST(CellOwnership, IsThatOfAllKnownBodies) {
  std::size_t known = 0, candidates = 0;
  for_each_random_cell([&](const InterfaceNetwork& network, const auto& vertices, std::mt19937_64& random) {
    const AllBodies all(network.table(), vertices);
    const CellOwnership found = ownership_of(network, vertices, {});
    known += all.known().size(), candidates += found.problem.candidates.size();
    for (int sample = 0; sample < 20; ++sample) {
      const Weights at = test::random_weights(random);
      double greatest = -std::numeric_limits<double>::infinity();
      for (const BodyId body : all.known()) greatest = std::max(greatest, all.value(body, at));
      const BodyId owner(found.pure() ? found.problem.candidates[0].owner : found.problem.owner(at));
      EXPECT_EQ(all.value(owner, at), greatest);
    }
  });
  EXPECT_LT(2 * candidates, known);  // most of them own nothing
}

TEST(CellOwnership, HasWhatIsNeeded) {
  for_each_random_cell([](const InterfaceNetwork& network, const auto& vertices, std::mt19937_64& random) {
    const AllBodies all(network.table(), vertices);
    if (all.known().size() == 1) return;  // then there are no functions
    std::vector<BodyId> bodies;
    std::vector<InterfaceId> interfaces;
    for (BodyId b(0); b.value < network.table().body_count(); ++b.value) {
      if (random() % 4 == 0) bodies.push_back(b);
    }
    for (InterfaceId i(0); i.value < network.table().interface_count(); ++i.value) {
      if (random() % 4 == 0) interfaces.push_back(i);
    }
    const double reach = 0.1 * vertices[0].radius;
    const CellOwnership found = ownership_of(network, vertices, {bodies, interfaces, reach});
    const auto& problem = found.problem;
    const auto is_candidate = [&](BodyId body) { return found.candidate(body) < problem.candidates.size(); };
    for (const BodyId body : bodies) EXPECT_TRUE(is_candidate(body) || !all.known().contains(body));
    for (const InterfaceId id : interfaces) {
      const auto& [a, b] = network.table().sides(id);
      const CellOwnership::Interface* interface = found.find(id);
      EXPECT_EQ(interface != nullptr, all.known().contains(a) && all.known().contains(b));
      if (interface == nullptr) continue;
      EXPECT_EQ(problem.functions[interface->towards_first].values, all.functions(a).at(id));
      EXPECT_EQ(problem.functions[interface->towards_second].values, all.functions(b).at(id));
    }
    for (int sample = 0; sample < 20; ++sample) {
      const Weights at = test::random_weights(random);
      double greatest = -std::numeric_limits<double>::infinity();
      for (const BodyId body : all.known()) greatest = std::max(greatest, all.value(body, at));
      for (const BodyId body : all.known()) {
        const double value = all.value(body, at);
        EXPECT_TRUE(is_candidate(body) || value < greatest - reach);
        if (!is_candidate(body)) continue;
        EXPECT_EQ(problem.value(problem.candidates[found.candidate(body)], at), value);
      }
    }
  });
}

}  // namespace
}  // namespace adamas
