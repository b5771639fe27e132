#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "interfaces/network/triangle_contacts.h"
#include "interfaces/simplification/near_field.h"
#include "interfaces/simplification/openmesh_patches.h"
#include "interfaces/simplification/patch_changes.h"
#include "interfaces/simplification/surface_guard.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

PlacedTriangle placed(std::array<std::uint32_t, 3> points, std::array<Vec3, 3> corners) {
  return {points, corners};
}

TEST(TriangleContacts, SharedCornersAndEdgesAreNone) {
  const PlacedTriangle first = placed({0, 1, 2}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}});
  EXPECT_FALSE(in_contact(first, placed({1, 0, 3}, {{{1, 0, 0}, {0, 0, 0}, {0, -1, 0}}})));
  EXPECT_FALSE(in_contact(first, placed({1, 0, 3}, {{{1, 0, 0}, {0, 0, 0}, {0, 1, 1e-9}}})));
  EXPECT_TRUE(in_contact(first, placed({1, 0, 3}, {{{1, 0, 0}, {0, 0, 0}, {0.5, 2, 0}}})));
  EXPECT_FALSE(in_contact(first, placed({0, 3, 4}, {{{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}}})));
  EXPECT_TRUE(in_contact(first, placed({0, 3, 4}, {{{0, 0, 0}, {1, 1, 1}, {1, 1, -1}}})));
  EXPECT_TRUE(in_contact(first, placed({3, 4, 5}, {{{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}}})));
  EXPECT_TRUE(in_contact(first, placed({2, 0, 1}, {{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}}})));
  EXPECT_FALSE(in_contact(first, placed({3, 4, 5}, {{{0, 0, 0}, {1, 1, 0}, {0.5, 0.5, 0}}}))) << "no area";
}

TEST(TriangleContacts, FoundInAMesh) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, MaterialId(0), MaterialId(1), 4);
  EXPECT_TRUE(find_contacts(mesh).empty());
  const auto base = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), {{0.3, 0.3, -1}, {0.31, 0.3, 1}, {0.3, 0.31, 1}});
  mesh.triangles.push_back({{base, base + 1, base + 2}, MaterialId(0), MaterialId(1)});
  const auto pairs = find_contacts(mesh);
  ASSERT_FALSE(pairs.empty());
  for (const auto& [a, b] : pairs) {
    EXPECT_LT(a, b);
    EXPECT_EQ(b, mesh.triangles.size() - 1);
  }
}

TEST(TriangleContacts, TetrahedraHoldWhatIsInsideOrOnThem) {
  const std::array<Vec3, 4> tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_TRUE(tetrahedron_contains(tetrahedron, {0.1, 0.1, 0.1}));
  EXPECT_TRUE(tetrahedron_contains(tetrahedron, {0.5, 0.5, 0}));
  EXPECT_FALSE(tetrahedron_contains(tetrahedron, {0.5, 0.5, 1e-12}));
  EXPECT_FALSE(tetrahedron_contains({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}, {0.5, 0.5, 0}))
      << "no volume";
}

/// Triangles that the near field accepts are near at every sample. It accepts all those whose distance is
/// less than most of the limit.
TEST(NearField, AgreesWithSamples) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.3, MaterialId(0), MaterialId(1), 12);
  const ClosestPointTree tree(mesh.points, test::triangles_of(mesh));
  std::mt19937_64 random(5);
  std::size_t taken = 0;
  for (const double reach : {0.003, 0.03, 0.3}) {
    NearField field(tree, reach);
    for (int i = 0; i < 300; ++i) {
      // The corners are near the sphere; some of the triangles are thin.
      std::array<Vec3, 3> corners;
      const Vec3 around = test::random_point(random, test::unit_box());
      for (Vec3& c : corners) {
        const Vec3 p = around + 0.3 * test::random_point(random, test::unit_box());
        c = tree.closest(p)->point +
            reach * (test::random_point(random, test::unit_box()) - Vec3{0.5, 0.5, 0.5});
      }
      if (i % 10 == 0) corners[2] = corners[1];
      double farthest = 0;
      for (int u = 0; u <= 20; ++u) {
        for (int v = 0; u + v <= 20; ++v) {
          const Vec3 p = u / 20.0 * corners[0] + v / 20.0 * corners[1] + (20 - u - v) / 20.0 * corners[2];
          farthest = std::max(farthest, std::sqrt(tree.closest(p)->squared_distance));
        }
      }
      const bool near = field.within(corners, reach);
      taken += near ? 1 : 0;
      if (near) {
        EXPECT_LE(farthest, reach * (1 + 1e-12));
      }
      if (farthest < 0.8 * reach) {
        EXPECT_TRUE(near) << farthest / reach;
      }
    }
  }
  EXPECT_GT(taken, 100u);
}

/// In a fan of triangles round an edge, the edge divides its quadrilateral badly, since it halves the wide
/// angle. It is flipped, and afterwards the guard and OpenMesh have the same triangles.
TEST(FlipEdges, MakesTheSmallestAngleGreater) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  mesh.points = {{0.1, 0.5, 0.5}, {0.9, 0.5, 0.5},  {0.5, 0.6, 0.5},
                 {0.5, 0.4, 0.5}, {0.5, 0.9, 0.52}, {0.5, 0.1, 0.48}};
  for (const std::array<std::uint32_t, 3>& t :
       {std::array<std::uint32_t, 3>{0, 1, 2}, {1, 0, 3}, {0, 2, 4}, {2, 1, 4}, {3, 0, 5}, {1, 3, 5}})
    mesh.triangles.push_back({t, MaterialId(0), MaterialId(1)});
  const std::vector<std::array<BodyId, 2>> sides(mesh.triangles.size(), {BodyId(0), BodyId(1)});
  auto patches = to_openmesh(mesh, sides);
  ASSERT_EQ(patches.size(), 1u);
  const std::vector<ClosestPointTree::Triangle> triangles = test::triangles_of(mesh);
  const ClosestPointTree tree(mesh.points, triangles);
  constexpr double kLimit = 0.1;
  std::vector<NearField> fields;
  fields.emplace_back(tree, kLimit);
  SurfaceGuard guard(mesh.points, triangles, std::vector<std::uint32_t>(6, 0),
                     std::vector<std::uint32_t>(6, 0), fields, {kLimit, test::unit_box()});
  const std::array<std::uint32_t, 2> pair{0, 1};
  const double before = guard.smallest_angle(pair);
  EXPECT_EQ(flip_edges(patches[0], guard, SilentProgress::instance()), 1u);
  EXPECT_GT(guard.smallest_angle(pair), 2 * before);
  const JoinedPatches joined = from_openmesh(patches, mesh.materials, mesh.source);
  const Vec3 up{0, 0, 1};
  bool has_new_edge = false;
  for (const InterfaceTriangle& t : joined.mesh.triangles) {
    const auto& p = joined.mesh.points;
    EXPECT_NE(dot(cross(p[t.points[1]] - p[t.points[0]], p[t.points[2]] - p[t.points[0]]), up), 0);
    const auto has = [&](std::uint32_t v) { return std::count(t.points.begin(), t.points.end(), v) == 1; };
    EXPECT_FALSE(has(0) && has(1));
    has_new_edge = has_new_edge || (has(2) && has(3));
  }
  EXPECT_TRUE(has_new_edge);
}

}  // namespace
}  // namespace adamas
