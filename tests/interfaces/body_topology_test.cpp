#include "interfaces/network/body_topology.h"

#include <gtest/gtest.h>

#include "core/base/parallel.h"
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

/// The topology does not depend on the order of triangles and of their corners.
TEST(BodyTopology, DoesNotDependOnOrder) {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  add_torus(mesh, {0.5, 0.5, 0.5}, 0.3, 0.1, MaterialId(0), MaterialId(1));
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.1, MaterialId(0), MaterialId(2));
  const auto expected = body_topology(mesh, 3, test::unit_box());
  const ClosestPointTree tree(mesh.points, test::triangles_of(mesh));
  EXPECT_EQ(body_topology(mesh, 3, test::unit_box(), &tree), expected);
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 5; ++trial) {
    std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
    for (InterfaceTriangle& t : mesh.triangles)
      std::rotate(t.points.begin(), t.points.begin() + random() % 3, t.points.end());
    EXPECT_EQ(body_topology(mesh, 3, test::unit_box()), expected);
  }
}

}  // namespace
}  // namespace adamas
