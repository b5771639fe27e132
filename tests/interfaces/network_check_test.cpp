#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "interfaces/network/interface_mesh_check.h"
#include "interfaces/network/triangle_contacts.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

const MaterialId kA(0), kB(1), kC(2);

InterfaceMesh good_mesh() {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.4, kA, kB);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.2, kB, kC);
  return mesh;
}

/// Returns the message for a mesh, which must be one line that names the mesh.
std::string message(const InterfaceMesh& mesh, const Box3* domain = nullptr) {
  try {
    check_interface_mesh(mesh, domain);
  } catch (const Error& e) {
    const std::string text = e.what();
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(text.rfind("test mesh: ", 0), 0u) << text;
    return text;
  }
  return "no error";
}

TEST(InterfaceCheck, AcceptsSpheres) {
  const InterfaceMesh mesh = good_mesh();
  const InterfaceMeshReport report = check_interface_mesh(mesh, nullptr);
  EXPECT_EQ(report.points, mesh.points.size());
  EXPECT_EQ(report.triangles, mesh.triangles.size());
  EXPECT_EQ(report.open_border_edges + report.junction_edges + report.domain_edges + report.flipped_edges,
            0u);
}

TEST(InterfaceCheck, NamesEveryFault) {
  using ::testing::HasSubstr;
  EXPECT_THAT(message(test::mesh_with_materials(2)), HasSubstr("found none"));
  InterfaceMesh mesh = good_mesh();
  mesh.points[7].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message(mesh), HasSubstr("point 7"));
  mesh = good_mesh();
  mesh.triangles[3].points[1] = 100000;
  EXPECT_THAT(message(mesh), HasSubstr("triangle 3: expected points below"));
  mesh = good_mesh();
  mesh.triangles[4].back = MaterialId(9);
  EXPECT_THAT(message(mesh), HasSubstr("triangle 4: expected materials below 3, found 9"));
  mesh = good_mesh();
  mesh.triangles[4].back = MaterialId();
  EXPECT_THAT(message(mesh), HasSubstr("triangle 4: expected materials below 3"));
  mesh = good_mesh();
  mesh.triangles[4].back = kA;
  EXPECT_THAT(message(mesh), HasSubstr("triangle 4: expected two materials, found a on both sides"));
  mesh = good_mesh();
  for (Vec3& p : mesh.points) p = {p.x, 0, 0};
  EXPECT_THAT(message(mesh), HasSubstr("expected triangles with an area"));
  mesh = good_mesh();
  std::swap(mesh.triangles[30].points[0], mesh.triangles[30].points[1]);
  EXPECT_THAT(message(mesh), HasSubstr("expected the same material on facing sides round the edge"));
  mesh = good_mesh();
  for (InterfaceTriangle& t : mesh.triangles) {
    if (t.back == kC) t.front = kA;
  }
  EXPECT_EQ(message(mesh), "no error");  // only rays could find this out
  mesh = good_mesh();
  test::add_sphere(mesh, {0.9, 0.5, 0.5}, 0.3, kA, kC);
  EXPECT_THAT(message(mesh), HasSubstr("pairs that intersect"));
}

TEST(InterfaceCheck, TellsOpenBordersFromTheDomains) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}, kA, kB, 4);
  const Box3 box = test::unit_box(), larger{{-1, -1, -1}, {2, 2, 2}};
  EXPECT_EQ(check_interface_mesh(mesh, &box).domain_edges, 16u);
  EXPECT_EQ(check_interface_mesh(mesh, &box).open_border_edges, 0u);
  EXPECT_EQ(check_interface_mesh(mesh, &larger).open_border_edges, 16u);
}

TEST(InterfaceCheck, JunctionsCloseUpOrFail) {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  const Vec3 up{0, 0, 1}, o{0.5, 0.5, 0};
  test::add_patch(mesh, o, {0.5, 0, 0}, up, kC, kA);
  test::add_patch(mesh, o, {-0.25, 0.5, 0}, up, kA, kB);
  test::add_patch(mesh, o, {-0.25, -0.5, 0}, up, kB, kC);
  const Box3 box = test::unit_box();
  EXPECT_EQ(check_interface_mesh(mesh, &box).junction_edges, 4u);
  for (std::size_t t = 0; t < 32; ++t) std::swap(mesh.triangles[t].front, mesh.triangles[t].back);
  EXPECT_NE(message(mesh, &box), "no error");
  InterfaceCheckOptions options;
  options.allow_flipped_edges = true;
  EXPECT_GT(check_interface_mesh(mesh, &box, options).flipped_edges, 0u);
}

TEST(InterfaceCheck, IntersectionsAreThoseOfBruteForce) {
  const InterfaceMesh mesh = test::random_soup(8, 600);
  const SelfIntersections found = find_self_intersections(mesh);
  // A triangle pierces another one where an edge of either crosses the other.
  const auto triangles = test::triangles_of(mesh);
  const auto pierces = [&](std::size_t s, std::size_t t) {
    const std::array<ClosestPointTree::Triangle, 1> one{triangles[t]};
    const ClosestPointTree tree(mesh.points, one);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = mesh.points[triangles[s][k]], b = mesh.points[triangles[s][(k + 1) % 3]];
      if (tree.first_hit(a, b - a, 1)) return true;
    }
    return false;
  };
  std::size_t expected = 0;
  for (std::size_t s = 0; s < triangles.size(); ++s) {
    if (s % 7 == 3) continue;
    for (std::size_t t = s + 1; t < triangles.size(); ++t) {
      if (t % 7 != 3 && (pierces(s, t) || pierces(t, s))) ++expected;
    }
  }
  EXPECT_EQ(found.count, expected);
  EXPECT_GT(expected, 50u);
}

}  // namespace
}  // namespace adamas
