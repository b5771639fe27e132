#include <gtest/gtest.h>

#include <set>

#include "interfaces/network/bodies.h"
#include "interfaces/network/interface_network.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

const MaterialId kA(0), kB(1), kC(2);

std::vector<int> bodies_per_material(const Bodies& bodies, std::size_t materials) {
  std::vector<int> count(materials, 0);
  for (const MaterialId m : bodies.materials) ++count[m.value];
  return count;
}

void expect_sides_have_their_materials(const InterfaceMesh& mesh, const Bodies& bodies) {
  ASSERT_EQ(bodies.sides.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    EXPECT_EQ(bodies.materials[bodies.sides[t][0]], mesh.triangles[t].front);
    EXPECT_EQ(bodies.materials[bodies.sides[t][1]], mesh.triangles[t].back);
  }
}

TEST(Bodies, ShellHasOneBodyAndTwoRoundIt) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.4, kA, kB);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.38, kB, kA);
  const Box3 box = test::unit_box();
  for (const Box3* domain : {&box, static_cast<const Box3*>(nullptr)}) {
    const Bodies bodies = find_bodies(mesh, domain);
    EXPECT_EQ(bodies_per_material(bodies, 2), (std::vector<int>{2, 1}));
    EXPECT_EQ(bodies.inconsistent_edges + bodies.inconsistent_rays, 0u);
    expect_sides_have_their_materials(mesh, bodies);
  }
}

TEST(Bodies, SlabIsOneBodyBetweenTwo) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}, kA, kB);
  test::add_patch(mesh, {0, 0, 0.45}, {1, 0, 0}, {0, 1, 0}, kB, kA);
  const Box3 box = test::unit_box();
  const Bodies bodies = find_bodies(mesh, &box);
  EXPECT_EQ(bodies_per_material(bodies, 2), (std::vector<int>{2, 1}));
  EXPECT_EQ(bodies.inconsistent_edges + bodies.inconsistent_rays, 0u);
}

TEST(Bodies, DisjointSpheresAreApartAndTheirSurroundingsOne) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  int count = 0;
  for (const double x : {0.2, 0.5, 0.8}) {
    for (const double y : {0.2, 0.5, 0.8}) {
      for (const double z : {0.2, 0.5, 0.8}) {
        test::add_sphere(mesh, {x, y, z}, 0.12, kA, kB, 6);
        ++count;
      }
    }
  }
  const Box3 box = test::unit_box();
  for (const Box3* domain : {&box, static_cast<const Box3*>(nullptr)}) {
    EXPECT_EQ(bodies_per_material(find_bodies(mesh, domain), 2), (std::vector<int>{1, count}));
  }
}

TEST(Bodies, CheckerboardQuartersStayApart) {
  // There are four quarters round a line, of materials a and b in turn; opposite ones touch along the line
  // only.
  InterfaceMesh mesh = test::mesh_with_materials(2);
  const Vec3 up{0, 0, 1}, o{0.5, 0.5, 0};
  test::add_patch(mesh, o, {0.5, 0, 0}, up, kA, kB);
  test::add_patch(mesh, o, {0, 0.5, 0}, up, kB, kA);
  test::add_patch(mesh, o, {-0.5, 0, 0}, up, kA, kB);
  test::add_patch(mesh, o, {0, -0.5, 0}, up, kB, kA);
  const Box3 box = test::unit_box();
  const Bodies bodies = find_bodies(mesh, &box);
  EXPECT_EQ(bodies.inconsistent_edges, 0u);
  EXPECT_EQ(bodies_per_material(bodies, 2), (std::vector<int>{2, 2}));
}

TEST(Bodies, SheetsThatMeetOnTheBoundaryDoNotJoinWhatTheyPart) {
  // Two sheets form a V whose edge is on the floor, with b inside. The two regions of a would meet only below
  // the floor.
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0.5, 0, 0}, {-0.5, 0, 1}, {0, 1, 0}, kA, kB);
  test::add_patch(mesh, {0.5, 0, 0}, {0.5, 0, 1}, {0, 1, 0}, kB, kA);
  const Box3 box = test::unit_box();
  const Bodies bodies = find_bodies(mesh, &box);
  EXPECT_EQ(bodies.inconsistent_edges + bodies.inconsistent_rays, 0u);
  EXPECT_EQ(bodies_per_material(bodies, 2), (std::vector<int>{2, 1}));
}

TEST(Bodies, BadOrientationIsCounted) {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.4, kA, kB);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.2, kC, kB);
  const Box3 box = test::unit_box();
  EXPECT_EQ(find_bodies(mesh, &box).inconsistent_edges, 0u);
  EXPECT_GT(find_bodies(mesh, &box).inconsistent_rays, 0u);
  std::swap(mesh.triangles[5].front, mesh.triangles[5].back);
  EXPECT_EQ(find_bodies(mesh, &box).inconsistent_edges, 3u);
}

/// Two grains whose distance is great compared with their size lie in one body of the material round them.
TEST(TinyBodies, LieInOneSurrounding) {
  for (const double size : {1e-2, 1e-3, 1e-4}) {
    InterfaceMesh mesh = test::mesh_with_materials(3);
    test::add_sphere(mesh, {0.71, 0.37, 0.25}, size, MaterialId(0), MaterialId(1), 3);
    test::add_sphere(mesh, {0.75, 0.75, 0.5}, 0.1 * size, MaterialId(0), MaterialId(2), 3);
    const InterfaceNetwork network(mesh, test::unit_box());
    EXPECT_EQ(network.table().body_count(), 3u) << size;
  }
}

}  // namespace
}  // namespace adamas
