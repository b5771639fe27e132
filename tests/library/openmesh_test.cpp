#include "adamas/openmesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "adamas/generate.h"
#include "adamas/reconstruct.h"
#include "adamas/resample.h"
#include "adamas/simplify.h"

namespace adamas {
namespace {

void expect_equal(const InterfaceTriangles& a, const InterfaceTriangles& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.sides, b.sides);
  EXPECT_EQ(a.materials, b.materials);
  EXPECT_EQ(a.bodies, b.bodies);
}

/// Expects that the triangles come back from the meshes of OpenMesh. Returns the number of these meshes.
std::size_t expect_round_trip(const InterfaceTriangles& given) {
  const auto meshes = to_openmesh(given);
  std::size_t faces = 0;
  for (const auto& interface : meshes) {
    if (interface.bodies) {
      EXPECT_LT((*interface.bodies)[0], (*interface.bodies)[1]);
    } else {
      EXPECT_LT(interface.front, interface.back);
    }
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
      std::swap(given.bodies[t][0], given.bodies[t][1]);
    }
    const auto [low, high] = std::minmax(given.sides[t][0], given.sides[t][1]);
    pairs.insert({low, high});
  }
  EXPECT_GE(expect_round_trip(given), pairs.size());
  given.bodies.clear();
  EXPECT_EQ(expect_round_trip(given), pairs.size());
}

/// Two balls of one material in another one, whose places, materials and topology are known.
class TwoBalls : public testing::Test {
 protected:
  static constexpr double kRadius = 0.2;
  static constexpr std::array<Vec3, 2> kCentres{Vec3{0.27, 0.3, 0.3}, Vec3{0.72, 0.68, 0.71}};

  static GridData data() {
    static const std::vector<std::uint8_t> kLabels = [] {
      std::vector<std::uint8_t> labels;
      for (std::size_t s = 0; s < grid().site_count(); ++s) {
        const Vec3 p = grid().site(s % kCells, s / kCells % kCells, s / kCells / kCells);
        labels.push_back(std::min(distance(p, kCentres[0]), distance(p, kCentres[1])) < kRadius ? 1 : 0);
      }
      return labels;
    }();
    GridData data{"balls", grid(), {"outside", "ball"}};
    data.labels = std::span<const std::uint8_t>(kLabels);
    return data;
  }

  /// Expects one closed surface for each ball, and that it and its bodies come back.
  static void expect_two_spheres(const InterfaceTriangles& found) {
    ASSERT_EQ(found.bodies.size(), found.triangles.size());
    EXPECT_EQ(expect_round_trip(found), 2u);
    const auto meshes = to_openmesh(found);
    std::set<std::uint32_t> balls, outside, places;
    for (const auto& interface : meshes) {
      const auto& mesh = interface.mesh;
      const auto count = [](std::size_t n) { return static_cast<std::int64_t>(n); };
      EXPECT_EQ(count(mesh.n_vertices()) - count(mesh.n_edges()) + count(mesh.n_faces()), 2);
      for (const auto edge : mesh.edges()) EXPECT_FALSE(mesh.is_boundary(edge));
      ASSERT_TRUE(interface.bodies.has_value());
      EXPECT_NE(interface.front, interface.back);
      const std::size_t ball = interface.front == 1 ? 0 : 1;
      balls.insert((*interface.bodies)[ball]), outside.insert((*interface.bodies)[1 - ball]);
      const std::uint32_t nearest = expect_sphere(interface, ball == 0);
      places.insert(nearest);
    }
    EXPECT_EQ(balls.size(), 2u);
    EXPECT_EQ(outside.size(), 1u);
    EXPECT_EQ(places, (std::set<std::uint32_t>{0, 1}));
    InterfaceTriangles of_materials = found;
    of_materials.bodies.clear();
    EXPECT_EQ(expect_round_trip(of_materials), 1u);
  }

 private:
  static constexpr std::size_t kCells = 20;

  static RectilinearGrid grid() {
    return RectilinearGrid::uniform({kCells, kCells, kCells}, {0, 0, 0},
                                    {1.0 / kCells, 1.0 / kCells, 1.0 / kCells});
  }

  /// Expects vertices on one of the balls and normals to `inside` or away from it; returns the ball's number.
  static std::uint32_t expect_sphere(const OpenMeshInterface<>& interface, bool inside) {
    const auto at = [&](auto vertex) {
      const auto& p = interface.mesh.point(vertex);
      return Vec3{p[0], p[1], p[2]};
    };
    const Vec3 first = at(*interface.mesh.vertices_begin());
    const std::uint32_t nearest = distance(first, kCentres[0]) < distance(first, kCentres[1]) ? 0 : 1;
    for (const auto vertex : interface.mesh.vertices())
      EXPECT_NEAR(distance(at(vertex), kCentres[nearest]), kRadius, 2.0 / kCells);
    double volume = 0;
    for (const auto face : interface.mesh.faces()) {
      std::vector<Vec3> corners;
      for (const auto vertex : interface.mesh.fv_range(face))
        corners.push_back(at(vertex) - kCentres[nearest]);
      volume += dot(corners[0], cross(corners[1], corners[2])) / 6;
    }
    const double wanted = 4.0 / 3 * M_PI * kRadius * kRadius * kRadius;
    EXPECT_NEAR(inside ? -volume : volume, wanted, 0.2 * wanted);
    return nearest;
  }
};

TEST_F(TwoBalls, OfReconstructionAreTwoMeshes) {
  const ReconstructedInterfaces found = reconstruct(data());
  EXPECT_EQ(found.bodies, 3u);
  expect_two_spheres(found.mesh);
  ReconstructOptions options;
  options.simplify.error = ErrorTarget{0.02};
  expect_two_spheres(reconstruct(data(), options).mesh);
}

TEST_F(TwoBalls, OfAResampledMeshAreTwoMeshesWithTheNumbersOfItsReport) {
  ResampleOptions options;
  options.interface_error = ErrorTarget{0.02};
  AdaptiveMesh mesh = resample(Input(data()), options);
  std::vector<InterfaceTriangles> all{mesh.interfaces(), mesh.input_interfaces()};
  mesh.release_input();
  all.push_back(mesh.interfaces());
  for (const InterfaceTriangles& found : all) {
    expect_two_spheres(found);
    for (std::size_t t = 0; t < found.triangles.size(); ++t) {
      for (std::size_t side = 0; side < 2; ++side)
        EXPECT_EQ(mesh.report().bodies.at(found.bodies[t][side]).material, found.sides[t][side]);
    }
  }
  SimplifyOptions simpler;
  simpler.error = ErrorTarget{0.02};
  expect_two_spheres(simplify(mesh, simpler).mesh);
}

/// Interfaces that are given have no bodies; those that come of them have.
TEST_F(TwoBalls, OfGivenInterfacesAreTwoMeshes) {
  InterfaceTriangles given = reconstruct(data()).mesh;
  given.bodies.clear();
  expect_two_spheres(reconstruct(Input(given, {{0, 0, 0}, {1, 1, 1}})).mesh);
}

TEST(OpenMeshConversion, RestoresTheStreamsOfOpenMesh) {
  const auto enabled = [] {
    return std::array{omlog().is_enabled(), omout().is_enabled(), omerr().is_enabled()};
  };
  const std::array before = enabled();
  omerr().enable(), omout().disable();
  const GeneratedScene scene = generate_scene("sphere", {8, 8, 8}, 1);
  ReconstructOptions options;
  options.simplify.error = ErrorTarget{0.02};
  static_cast<void>(to_openmesh(reconstruct(scene.data.view(), options).mesh));
  EXPECT_EQ(enabled(), (std::array{before[0], false, true}));
  if (before[1]) omout().enable();
  if (!before[2]) omerr().disable();
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
  given = of_two_materials({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {2, 1, 3}});
  given.bodies = {{3, 5}};
  EXPECT_THROW(to_openmesh(given), Error);
  given.bodies = {{3, 5}, {3, 5}};
  EXPECT_EQ(expect_round_trip(given), 1u);
  given.sides[1] = {1, 0};
  EXPECT_THROW(to_openmesh(given), Error);
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
