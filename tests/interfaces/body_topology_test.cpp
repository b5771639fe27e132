#include "interfaces/network/body_topology.h"

#include <gtest/gtest.h>

#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "datasets/scene_sampling.h"
#include "interfaces/input/grid_source.h"
#include "interfaces/input/mesh_source.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

/// Adds a torus round the z axis through the centre, of 2 n^2 triangles with normals outwards.
void add_torus(InterfaceMesh& mesh, const Vec3& center, double radius, double tube, MaterialId outside,
               MaterialId inside, std::uint32_t n = 12) {
  const auto base = static_cast<std::uint32_t>(mesh.points.size());
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const double u = 2 * M_PI * i / n, v = 2 * M_PI * j / n;
      const double r = radius + tube * std::cos(v);
      mesh.points.push_back(center + Vec3{r * std::cos(u), r * std::sin(u), tube * std::sin(v)});
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return base + (i % n) * n + j % n; };
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      mesh.triangles.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, outside, inside});
      mesh.triangles.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, outside, inside});
    }
  }
}

BodyTopology topology(const InterfaceMesh& mesh, std::size_t bodies, std::size_t body) {
  return body_topology(mesh, bodies, test::unit_box())[BodyId(body)];
}

TEST(BodyTopology, OfClosedSurfaces) {
  InterfaceMesh sphere = test::mesh_with_materials(2);
  test::add_sphere(sphere, {0.5, 0.5, 0.5}, 0.3, MaterialId(0), MaterialId(1));
  EXPECT_EQ(topology(sphere, 2, 0), (BodyTopology{1, 2}));
  EXPECT_EQ(topology(sphere, 2, 1), (BodyTopology{1, 2}));

  InterfaceMesh torus = test::mesh_with_materials(2);
  add_torus(torus, {0.5, 0.5, 0.5}, 0.3, 0.1, MaterialId(0), MaterialId(1));
  EXPECT_EQ(topology(torus, 2, 1), (BodyTopology{1, 0}));

  InterfaceMesh shell = test::mesh_with_materials(3);
  test::add_sphere(shell, {0.5, 0.5, 0.5}, 0.3, MaterialId(0), MaterialId(1));
  test::add_sphere(shell, {0.5, 0.5, 0.5}, 0.2, MaterialId(1), MaterialId(2));
  EXPECT_EQ(topology(shell, 3, 0), (BodyTopology{1, 2}));
  EXPECT_EQ(topology(shell, 3, 1), (BodyTopology{1, 4}));
  EXPECT_EQ(topology(shell, 3, 2), (BodyTopology{1, 2}));
}

TEST(BodyTopology, CountsPiecesOfABody) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  for (const double x : {0.2, 0.5, 0.8})
    test::add_sphere(mesh, {x, 0.5, 0.5}, 0.1, MaterialId(0), MaterialId(1));
  EXPECT_EQ(topology(mesh, 2, 0), (BodyTopology{1, 6}));
  EXPECT_EQ(topology(mesh, 2, 1), (BodyTopology{3, 6}));
  EXPECT_EQ(topology(mesh, 3, 2), BodyTopology{}) << "a body that is not there";
}

TEST(BodyTopology, EndsAtTheFacesOfTheDomain) {
  // A plane through the box is a disk on both sides. The boundary of a tube is its lateral surface alone,
  // without the ends on the domain's faces.
  InterfaceMesh plane = test::mesh_with_materials(2);
  test::add_patch(plane, {0, 0, 0.4}, {1, 0, 0}, {0, 1, 0}, MaterialId(0), MaterialId(1));
  EXPECT_EQ(topology(plane, 2, 0), (BodyTopology{1, 1}));
  InterfaceMesh tube = test::mesh_with_materials(2);
  const Vec3 corners[4] = {{0.3, 0.3, 0}, {0.7, 0.3, 0}, {0.7, 0.7, 0}, {0.3, 0.7, 0}};
  for (std::size_t i = 0; i < 4; ++i)
    test::add_patch(tube, corners[i], corners[(i + 1) % 4] - corners[i], {0, 0, 1}, MaterialId(0),
                    MaterialId(1));
  EXPECT_EQ(topology(tube, 2, 1), (BodyTopology{1, 0}));
}

/// Two boxes of one body that touch along an edge, or at a corner, are two pieces, each with the boundary of
/// a ball; what is round them is one.
TEST(BodyTopology, ToldApartWhereABodyTouchesItself) {
  for (const Vec3 shift : {Vec3{0.2, 0.2, 0}, Vec3{0.2, 0.2, 0.2}}) {
    InterfaceMesh mesh = test::mesh_with_materials(2);
    for (const Vec3& o : {Vec3{0.3, 0.3, 0.3}, Vec3{0.3, 0.3, 0.3} + shift}) {
      const Vec3 e[3] = {{0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.2}};
      for (std::size_t a = 0; a < 3; ++a) {
        const Vec3 &u = e[(a + 1) % 3], &v = e[(a + 2) % 3];
        test::add_patch(mesh, o, v, u, MaterialId(0), MaterialId(1), 1);
        test::add_patch(mesh, o + e[a], u, v, MaterialId(0), MaterialId(1), 1);
      }
    }
    EXPECT_EQ(topology(mesh, 2, 1), (BodyTopology{2, 4}));
    EXPECT_EQ(topology(mesh, 2, 0).pieces, 1u);
  }
}

/// Adds the sides of two boxes that share a wall: bodies 1 and 2 in body 0.
void add_two_boxes(InterfaceMesh& mesh) {
  const Vec3 e[3] = {{0.25, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4}};
  for (std::size_t body = 1; body <= 2; ++body) {
    const Vec3 o{0.25 * static_cast<double>(body), 0.3, 0.3};
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3 &u = e[(a + 1) % 3], &v = e[(a + 2) % 3];
      const MaterialId inside(body), outside(0);
      if (a > 0 || body == 1) test::add_patch(mesh, o, v, u, outside, inside, 1);
      test::add_patch(mesh, o + e[a], u, v, a == 0 && body == 1 ? MaterialId(2) : outside, inside, 1);
    }
  }
}

/// Triangles that are all but flat have angles round their edges which round-off may turn by any amount.
/// Where three bodies meet, the bodies tell which triangles bound the same one.
TEST(BodyTopology, DoesNotDependOnTheAnglesOfFlatTriangles) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    InterfaceMesh mesh = test::mesh_with_materials(3);
    add_two_boxes(mesh);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> shift(-1e-7, 1e-7);
    const std::size_t triangles = mesh.triangles.size();
    for (std::size_t t = 0; t < triangles; ++t) {
      // A point beside the middle of each edge in turn takes a corner's place.
      for (std::size_t i = 0; i < 3; ++i) {
        const InterfaceTriangle whole = mesh.triangles[t];
        const std::uint32_t a = whole.points[i], b = whole.points[(i + 1) % 3], c = whole.points[(i + 2) % 3];
        const auto middle = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(0.5 * (mesh.points[a] + mesh.points[b]) +
                              Vec3{shift(random), shift(random), shift(random)});
        mesh.triangles[t].points = {a, b, middle};
        mesh.triangles.push_back({{b, c, middle}, whole.front, whole.back});
        mesh.triangles.push_back({{c, a, middle}, whole.front, whole.back});
        std::swap(mesh.triangles[t], mesh.triangles.back());
      }
    }
    for (const std::size_t body : {0u, 1u, 2u})
      EXPECT_EQ(topology(mesh, 3, body), (BodyTopology{1, 2})) << "body " << body << ", seed " << seed;
  }
}

/// The topology does not depend on the order of triangles and of their corners.
TEST(BodyTopology, DoesNotDependOnOrder) {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  add_torus(mesh, {0.5, 0.5, 0.5}, 0.3, 0.1, MaterialId(0), MaterialId(1));
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.1, MaterialId(0), MaterialId(2));
  const auto expected = body_topology(mesh, 3, test::unit_box());
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 5; ++trial) {
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    for (InterfaceTriangle& t : mesh.triangles)
      std::rotate(t.points.begin(), t.points.begin() + random() % 3, t.points.end());
    EXPECT_EQ(body_topology(mesh, 3, test::unit_box()), expected);
  }
}

/// Returns the interfaces of a network as a mesh with bodies in place of materials.
InterfaceMesh mesh_of_bodies(const InterfaceNetwork& network) {
  InterfaceMesh mesh;
  mesh.points.assign(network.points().begin(), network.points().end());
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& [front, back] = network.table().sides(network.interface_of(t));
    mesh.triangles.push_back({network.triangles()[t], MaterialId(front.value), MaterialId(back.value)});
  }
  return mesh;
}

void expect_topology_of_mesh(const InterfaceNetwork& network, const Box3& box) {
  ASSERT_EQ(network.inconsistencies(), 0u);
  ASSERT_FALSE(network.has_open_border());
  const auto expected = body_topology(mesh_of_bodies(network), network.table().body_count(), box);
  for (const std::size_t points_at_once : {200u, 1u << 20}) {
    SCOPED_TRACE(points_at_once);
    EXPECT_EQ(body_topology(network, box, points_at_once), expected);
  }
}

/// Returns labels of single voxels, a part of which are not the first one.
MultiMaterialData random_labels(std::uint16_t materials, double part, std::mt19937_64& random) {
  MultiMaterialData data;
  data.source = "labels";
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i <= 9 - a; ++i) data.grid.nodes[a].push_back(static_cast<double>(i));
  }
  for (std::uint16_t m = 0; m < materials; ++m) data.materials.push_back(std::to_string(m));
  for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
    const bool first = std::uniform_real_distribution()(random) >= part;
    data.labels.push_back(first ? std::uint16_t{0}
                                : static_cast<std::uint16_t>(1 + random() % (materials - 1)));
  }
  return data;
}

/// Whatever number of points is looked at once, the bodies of a network have the topology of its mesh.
TEST(BodyTopology, OfANetworkIsThatOfItsMesh) {
  std::mt19937_64 random(7);
  for (const std::uint16_t materials : {2, 4}) {
    for (const double part : {0.1, 0.5}) {
      SCOPED_TRACE(part);
      const MultiMaterialData data = random_labels(materials, part, random);
      const ResamplingSource source = make_grid_source(data);
      expect_topology_of_mesh(*source.network, source.box);
    }
  }
  for (const char* name : {"voronoi10", "shell3", "random", "tjunction"}) {
    SCOPED_TRACE(name);
    const datasets::Scene scene = datasets::make_scene(name, 2);
    const MultiMaterialData data = datasets::sample_scene(scene, {7, 8, 9});
    expect_topology_of_mesh(*make_grid_source(data).network, scene.box());
    const InterfaceMesh mesh = datasets::scene_interfaces(scene, 0.1);
    expect_topology_of_mesh(*make_mesh_source(mesh, scene.box(), nullptr).network, scene.box());
  }
}

}  // namespace
}  // namespace adamas
