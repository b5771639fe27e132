#include "adamas/openmesh.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "adamas/generate.h"
#include "adamas/reconstruct.h"
#include "adamas/resample.h"

namespace adamas {
namespace {

void expect_equal(const InterfaceTriangles& a, const InterfaceTriangles& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.sides, b.sides);
  EXPECT_EQ(a.materials, b.materials);
}

/// Expects that the triangles come back from the meshes of OpenMesh. Returns the number of these meshes.
std::size_t expect_round_trip(const InterfaceTriangles& given) {
  const auto meshes = to_openmesh(given);
  std::size_t faces = 0;
  for (const auto& interface : meshes) {
    EXPECT_LT(interface.front, interface.back);
    faces += interface.mesh.n_faces();
    for (const auto vertex : interface.mesh.vertices()) {
      EXPECT_FALSE(interface.mesh.is_isolated(vertex));
      EXPECT_TRUE(interface.mesh.is_manifold(vertex));
    }
  }
  EXPECT_EQ(faces, given.triangles.size());
  expect_equal(from_openmesh(meshes, given.materials), given);
  return meshes.size();
}

InterfaceTriangles of_two_materials(std::vector<Vec3> points,
                                    std::vector<std::array<std::uint32_t, 3>> triangles) {
  InterfaceTriangles result{std::move(points), std::move(triangles), {}, {"a", "b"}};
  result.sides.assign(result.triangles.size(), {0, 1});
  return result;
}

/// The test uses every point, since points without triangles do not come back.
TEST(OpenMeshConversion, InterfacesOfAMeshComeBack) {
  const GeneratedScene scene = generate_scene("voronoi10", {10, 10, 10}, 2);
  InterfaceTriangles given = reconstruct(scene.data.view()).mesh;
  ASSERT_GT(given.triangles.size(), 1000u);
  std::set<std::array<std::uint32_t, 2>> pairs;
  for (std::size_t t = 0; t < given.triangles.size(); ++t) {
    if (t % 3 == 0) {
      std::swap(given.triangles[t][0], given.triangles[t][1]);
      std::swap(given.sides[t][0], given.sides[t][1]);
    }
    const auto [low, high] = std::minmax(given.sides[t][0], given.sides[t][1]);
    pairs.insert({low, high});
  }
  EXPECT_EQ(expect_round_trip(given), pairs.size());
}

/// Normals of faces point into the front material.
TEST(OpenMeshConversion, FacesTurnToTheLowerMaterial) {
  InterfaceTriangles given = of_two_materials({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  for (const bool turned : {false, true}) {
    given.sides[0] = turned ? std::array{1u, 0u} : std::array{0u, 1u};
    const auto meshes = to_openmesh(given);
    ASSERT_EQ(meshes.size(), 1u);
    EXPECT_EQ(meshes[0].front, 0u);
    EXPECT_EQ(meshes[0].back, 1u);
    const auto& mesh = meshes[0].mesh;
    EXPECT_EQ(mesh.calc_face_normal(mesh.face_handle(0))[2], turned ? -1 : 1);
    expect_round_trip(given);
  }
}

TEST(OpenMeshConversion, JunctionsAndEdgesOfThreeSheetsAreBorders) {
  // First three sheets of one pair of materials meet at an edge, then three sheets of three pairs.
  InterfaceTriangles given = of_two_materials({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                                              {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}});
  EXPECT_EQ(expect_round_trip(given), 1u);
  const auto sheets = to_openmesh(given);
  EXPECT_EQ(sheets[0].mesh.n_vertices(), 9u);
  given.materials = {"a", "b", "c"};
  given.sides = {{0, 1}, {1, 2}, {2, 0}};
  EXPECT_EQ(expect_round_trip(given), 3u);
  const auto meshes = to_openmesh(given);
  for (const auto& interface : meshes) {
    for (const auto edge : interface.mesh.edges()) EXPECT_TRUE(interface.mesh.is_boundary(edge));
  }
}

TEST(OpenMeshConversion, FansThatTouchAtAPointHaveVerticesOfTheirOwn) {
  const InterfaceTriangles given =
      of_two_materials({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 1}, {0, -1, 1}}, {{0, 1, 2}, {0, 3, 4}});
  EXPECT_EQ(expect_round_trip(given), 1u);
  const auto meshes = to_openmesh(given);
  EXPECT_EQ(meshes[0].mesh.n_vertices(), 6u);
}

TEST(OpenMeshConversion, TrianglesOnTheSamePointsComeBack) {
  expect_round_trip(
      of_two_materials({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}, {0, 2, 1}, {0, 1, 2}}));
  expect_round_trip(of_two_materials({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}));
}

/// The triangles are random and on few points, so that most of them conflict.
TEST(OpenMeshConversion, RandomTrianglesComeBack) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::mt19937_64 random(seed);
    InterfaceTriangles given;
    given.materials = {"a", "b", "c"};
    for (int i = 0; i < 8; ++i) {
      given.points.push_back(
          {static_cast<double>(random() % 100), static_cast<double>(random() % 100), static_cast<double>(i)});
    }
    while (given.triangles.size() < 60) {
      const auto pick = [&random](std::uint32_t below) {
        return static_cast<std::uint32_t>(random() % below);
      };
      const std::uint32_t a = pick(8), b = pick(8), c = pick(8), front = pick(3), back = pick(3);
      if (a == b || b == c || c == a || front == back) continue;
      given.triangles.push_back({a, b, c});
      given.sides.push_back({front, back});
    }
    expect_round_trip(given);
  }
}

/// The test does with a mesh what algorithms of OpenMesh do: it deletes faces, divides them and moves
/// vertices.
TEST(OpenMeshConversion, ChangesComeBack) {
  const InterfaceTriangles given =
      of_two_materials({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}},
                       {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}});
  auto meshes = to_openmesh(given);
  auto& mesh = meshes.at(0).mesh;
  const auto middle = mesh.add_vertex({1.8, 0.2, 0.5});
  mesh.split(mesh.face_handle(2), middle);
  mesh.request_face_status(), mesh.request_edge_status(), mesh.request_vertex_status();
  mesh.delete_face(mesh.face_handle(0));
  InterfaceTriangles marked = from_openmesh(meshes, given.materials);
  mesh.garbage_collection();
  InterfaceTriangles found = from_openmesh(meshes, given.materials);
  // Faces that were added later have the order of the mesh.
  std::sort(marked.triangles.begin() + 2, marked.triangles.end());
  std::sort(found.triangles.begin() + 2, found.triangles.end());
  expect_equal(marked, found);
  ASSERT_EQ(found.triangles.size(), 5u);
  EXPECT_EQ(found.triangles[0], (std::array<std::uint32_t, 3>{0, 2, 3}));
  ASSERT_EQ(found.points.size(), 7u);
  EXPECT_EQ(found.points.back(), (Vec3{1.8, 0.2, 0.5}));
}

TEST(OpenMeshConversion, LeavesOutTrianglesOfTwoPoints) {
  const InterfaceTriangles given =
      of_two_materials({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 1}});
  const auto meshes = to_openmesh(given);
  EXPECT_EQ(meshes.at(0).mesh.n_faces(), 1u);
  EXPECT_EQ(from_openmesh(meshes, given.materials).triangles.size(), 1u);
}

TEST(OpenMeshConversion, ChecksItsInput) {
  InterfaceTriangles given = of_two_materials({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  given.sides.clear();
  EXPECT_THROW(to_openmesh(given), Error);
  EXPECT_THROW(to_openmesh(of_two_materials({{0, 0, 0}}, {{0, 1, 2}})), Error);
}

/// Meshes may have other traits: single precision and attributes of their own.
TEST(OpenMeshConversion, TakesOtherMeshes) {
  struct Traits : OpenMesh::DefaultTraits {
    VertexAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status | OpenMesh::Attributes::Normal);
    EdgeAttributes(OpenMesh::Attributes::Status);
  };
  const InterfaceTriangles given = of_two_materials({{0, 0, 0}, {1, 0, 0}, {0, 0.5, 0}}, {{0, 1, 2}});
  expect_equal(from_openmesh(to_openmesh<OpenMesh::TriMesh_ArrayKernelT<Traits>>(given), given.materials),
               given);
}

}  // namespace
}  // namespace adamas
