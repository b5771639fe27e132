#include "interfaces/simplification/openmesh_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "core/base/error.h"
#include "tests/interfaces/network_meshes.h"
#include "tests/interfaces/simplification_scenes.h"

namespace adamas {

using namespace interfaces;

namespace {

using Sides = std::vector<std::array<BodyId, 2>>;

/// A triangle by the places of its corners, beginning with the lowest one, as seen from the lower body.
using Placed = std::tuple<std::array<std::array<double, 3>, 3>, BodyId, BodyId>;

std::multiset<Placed> placed(const InterfaceMesh& mesh, const Sides& sides) {
  std::multiset<Placed> result;
  for (std::size_t t = 0; t < sides.size(); ++t) {
    std::array<std::array<double, 3>, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3& p = mesh.points[mesh.triangles[t].points[c]];
      corners[c] = {p.x, p.y, p.z};
    }
    auto [front, back] = sides[t];
    if (back < front) std::swap(front, back), std::swap(corners[1], corners[2]);
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    result.insert({corners, front, back});
  }
  return result;
}

void expect_round_trip(const InterfaceMesh& mesh, const Sides& sides, std::size_t patches) {
  const auto found = to_openmesh(mesh, sides);
  EXPECT_EQ(found.size(), patches);
  std::size_t faces = 0;
  for (const InterfacePatch& patch : found) {
    faces += patch.mesh.n_faces();
    EXPECT_LT(patch.front_body(), patch.back_body());
    for (const auto edge : patch.mesh.edges()) EXPECT_FALSE(patch.mesh.status(edge).deleted());
  }
  EXPECT_EQ(faces, mesh.triangles.size());
  const JoinedPatches joined = from_openmesh(found, mesh.materials, "joined");
  EXPECT_EQ(placed(joined.mesh, joined.bodies), placed(mesh, sides));
  std::map<BodyId, MaterialId> materials;
  for (std::size_t t = 0; t < sides.size(); ++t)
    materials[sides[t][0]] = mesh.triangles[t].front, materials[sides[t][1]] = mesh.triangles[t].back;
  for (std::size_t t = 0; t < joined.bodies.size(); ++t) {
    EXPECT_EQ(joined.mesh.triangles[t].front, materials[joined.bodies[t][0]]);
    EXPECT_EQ(joined.mesh.triangles[t].back, materials[joined.bodies[t][1]]);
  }
}

Sides one_interface(std::size_t count) { return Sides(count, {BodyId(0), BodyId(1)}); }

TEST(OpenMeshPatches, OnePerPairOfBodies) {
  const ResamplingSource source = test::reconstructed_scene("voronoi10", 8, 2);
  InterfaceMesh mesh = test::interfaces_of(source);
  Sides sides = triangle_bodies(*source.network);
  for (std::size_t t = 0; t < sides.size(); t += 3) {
    std::swap(sides[t][0], sides[t][1]);
    std::swap(mesh.triangles[t].front, mesh.triangles[t].back);
  }
  expect_round_trip(mesh, sides, source.network->table().interface_count());
}

TEST(OpenMeshPatches, ThreeSheetsOfOneInterfaceAtAnEdge) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  mesh.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
  for (const std::uint32_t p : {2u, 3u, 4u})
    mesh.triangles.push_back({{0, 1, p}, MaterialId(0), MaterialId(1)});
  expect_round_trip(mesh, one_interface(3), 1);
}

TEST(OpenMeshPatches, TwoFansThatTouchAtAPoint) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, MaterialId(0), MaterialId(1), 2);
  const auto count = static_cast<std::uint32_t>(mesh.points.size());
  test::add_patch(mesh, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, MaterialId(0), MaterialId(1), 2);
  // The middles of both patches become one point.
  for (InterfaceTriangle& t : mesh.triangles) {
    for (std::uint32_t& p : t.points) p = p == count + 4 ? 4 : p;
  }
  expect_round_trip(mesh, one_interface(mesh.triangles.size()), 1);
  const auto patches = to_openmesh(mesh, one_interface(mesh.triangles.size()));
  EXPECT_EQ(patches[0].mesh.n_vertices(), 2 * count);
}

TEST(OpenMeshPatches, TrianglesOnTheSamePointsAreSeveralPatches) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (int i = 0; i < 3; ++i) mesh.triangles.push_back({{0, 1, 2}, MaterialId(0), MaterialId(1)});
  mesh.triangles.push_back({{0, 2, 1}, MaterialId(0), MaterialId(1)});
  const auto patches = to_openmesh(mesh, one_interface(4));
  std::size_t faces = 0;
  for (const InterfacePatch& patch : patches) faces += patch.mesh.n_faces();
  EXPECT_EQ(faces, 4u);
  expect_round_trip(mesh, one_interface(4), patches.size());
}

/// The triangles are random and on few points, so that most of them conflict.
TEST(OpenMeshPatches, NothingIsLostOfRandomTriangles) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::mt19937_64 random(seed);
    InterfaceMesh mesh = test::mesh_with_materials(2);
    for (int i = 0; i < 8; ++i) mesh.points.push_back(test::random_point(random, test::unit_box()));
    Sides sides;
    while (mesh.triangles.size() < 40) {
      const auto pick = [&random] { return static_cast<std::uint32_t>(random() % 8); };
      const std::uint32_t a = pick(), b = pick(), c = pick();
      if (a == b || b == c || c == a) continue;
      mesh.triangles.push_back({{a, b, c}, MaterialId(0), MaterialId(1)});
      sides.push_back({BodyId(random() % 2), BodyId(2 + random() % 2)});
      if (random() % 2 == 0) continue;
      std::swap(sides.back()[0], sides.back()[1]);
      std::swap(mesh.triangles.back().front, mesh.triangles.back().back);
    }
    expect_round_trip(mesh, sides, to_openmesh(mesh, sides).size());
  }
}

TEST(OpenMeshPatches, LeavesOutTrianglesOfTwoPoints) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{{0, 1, 2}, MaterialId(0), MaterialId(1)}, {{0, 1, 1}, MaterialId(0), MaterialId(1)}};
  EXPECT_EQ(to_openmesh(mesh, one_interface(2)).at(0).mesh.n_faces(), 1u);
  EXPECT_THROW(to_openmesh(mesh, one_interface(1)), Error);
}

}  // namespace
}  // namespace adamas
