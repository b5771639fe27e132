#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <random>

#include "interfaces/network/interface_network.h"
#include "interfaces/ownership/cell_ownership.h"
#include "tests/interfaces/network_meshes.h"
#include "tests/support/ownership_problems.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Three half-planes that end at a common line, with regions of the given angles in degrees between them.
class Junction {
 public:
  explicit Junction(const std::array<double, 3>& degrees) {
    InterfaceMesh mesh = test::mesh_with_materials(3);
    double at = 20;
    for (std::size_t i = 0; i < 3; ++i) {
      angles_[i] = at * M_PI / 180;
      const Vec3 along{std::cos(angles_[i]), std::sin(angles_[i]), 0};
      // Region i lies between sheets i and i + 1; the normal points to smaller angles.
      test::add_patch(mesh, {0, 0, -9}, 9 * along, {0, 0, 18}, MaterialId((i + 2) % 3), MaterialId(i), 1);
      at += degrees[i];
    }
    network_ = std::make_unique<InterfaceNetwork>(mesh, Box3{{-6, -6, -6}, {6, 6, 6}});
  }
  [[nodiscard]] const InterfaceNetwork& network() const { return *network_; }
  [[nodiscard]] std::uint32_t region(const Vec3& p) const {
    double angle = std::atan2(p.y, p.x);
    while (angle < angles_[0]) angle += 2 * M_PI;
    return angle < angles_[1] ? 0 : (angle < angles_[2] ? 1 : 2);
  }
  /// Returns the distance from the nearest sheet.
  [[nodiscard]] double depth(const Vec3& p) const {
    return std::sqrt(network_->tree().closest(p)->squared_distance);
  }

 private:
  std::array<double, 3> angles_{};
  std::unique_ptr<InterfaceNetwork> network_;
};

struct Wrong {
  double share = 0;  ///< part of the cells' volume that goes to a wrong region
  double depth = 0;  ///< greatest distance of such a point from the interfaces, in units of the cells' size
};

/// Measures cells of size 1, shaped like those of the hierarchy, at random places round the line.
Wrong measure(const std::array<double, 3>& degrees, int cells) {
  const Junction junction(degrees);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  Wrong result;
  for (int i = 0; i < cells; ++i) {
    // This is a tetrahedron of a cube of side 1, turned at random.
    const double a = 2 * M_PI * unit(random), b = std::acos(2 * unit(random) - 1),
                 c = 2 * M_PI * unit(random);
    const auto turned = [&](Vec3 p) {
      p = {std::cos(a) * p.x - std::sin(a) * p.y, std::sin(a) * p.x + std::cos(a) * p.y, p.z};
      p = {p.x, std::cos(b) * p.y - std::sin(b) * p.z, std::sin(b) * p.y + std::cos(b) * p.z};
      return Vec3{std::cos(c) * p.x - std::sin(c) * p.y, std::sin(c) * p.x + std::cos(c) * p.y, p.z};
    };
    const Vec3 shift{unit(random), unit(random), unit(random)};
    std::array<Vec3, 4> corners{Vec3{0, 0, 0}, Vec3{1, 1, 1}, Vec3{1, 0, 0}, Vec3{1, 1, 0}};
    std::array<VertexDistances, 4> distances;
    for (std::size_t v = 0; v < 4; ++v) {
      corners[v] = turned(corners[v] - shift);
      distances[v].radius = std::sqrt(3.0);
      distances[v].body = junction.network().body_at(corners[v]);
      std::vector<NearInterface> near;
      junction.network().near_interfaces(corners[v], distances[v].radius, distances[v].body, near);
      for (const NearInterface& n : near) distances[v].near.push_back({n.interface, n.signed_distance});
      list_known_bodies(junction.network().table(), distances[v]);
    }
    CellOwnership ownership;
    find_cell_ownership(junction.network().table(),
                        {&distances[0], &distances[1], &distances[2], &distances[3]}, ownership);
    int wrong = 0;
    constexpr int kSamples = 60;
    for (int s = 0; s < kSamples; ++s) {
      const Weights w = test::random_weights(random);
      Vec3 p;
      for (std::size_t v = 0; v < 4; ++v) p += w[v] * corners[v];
      const BodyId body(ownership.pure() ? ownership.problem.candidates[0].owner
                                         : test::brute_owner(ownership.problem, w, 0).owner);
      if (junction.network().table().material(body).value == junction.region(p)) continue;
      const double depth = junction.depth(p);
      if (depth < 1e-9) continue;
      ++wrong;
      result.depth = std::max(result.depth, depth);
    }
    result.share += static_cast<double>(wrong) / kSamples / cells;
  }
  std::printf("junction of %g, %g, %g degrees: wrongly assigned %.4f, worst depth %.3f h\n", degrees[0],
              degrees[1], degrees[2], result.share, result.depth);
  return result;
}

TEST(OwnershipJunctions, PlaneJunctionsWithoutReflexRegionsAreExact) {
  for (const std::array<double, 3> degrees :
       {std::array<double, 3>{180, 90, 90}, {120, 120, 120}, {20, 170, 170}, {90, 150, 120}}) {
    const Wrong wrong = measure(degrees, 3000);
    EXPECT_EQ(wrong.share, 0);
    EXPECT_EQ(wrong.depth, 0);
  }
}

TEST(OwnershipJunctions, ReflexRegionsAreWithinBounds) {
  const Wrong wrong = measure({240, 60, 60}, 6000);
  EXPECT_LT(wrong.share, 0.066);  // as a part of the volume
  EXPECT_LT(wrong.depth, 0.43);   // in units of the cells' size
}

}  // namespace
}  // namespace adamas
