#include <gtest/gtest.h>

#include <set>

#include "core/base/error.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/network/interface_mesh_check.h"
#include "interfaces/network/interface_network.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::random_point;

const MaterialId kA(0), kB(1), kC(2);

/// Three half-planes that leave the line x = y = 0.5 in the given directions; region i lies between
/// directions i and i + 1.
struct Junction {
  explicit Junction(const std::array<double, 3>& degrees) {
    mesh = test::mesh_with_materials(3);
    for (std::size_t i = 0; i < 3; ++i) {
      angles[i] = degrees[i] * M_PI / 180;
      directions[i] = {std::cos(angles[i]), std::sin(angles[i]), 0};
      // The normal of dir x up points to smaller angles.
      test::add_patch(mesh, {0.5, 0.5, 0}, 2 * directions[i], {0, 0, 1}, MaterialId((i + 2) % 3),
                      MaterialId(i), 6);
    }
  }
  [[nodiscard]] std::size_t region(const Vec3& p) const {
    double angle = std::atan2(p.y - 0.5, p.x - 0.5);
    while (angle < angles[0]) angle += 2 * M_PI;
    return angle < angles[1] ? 0 : (angle < angles[2] ? 1 : 2);
  }
  InterfaceMesh mesh;
  std::array<double, 3> angles;
  std::array<Vec3, 3> directions;
};

const std::array<std::array<double, 3>, 5> kJunctions{
    {{0, 120, 240}, {0, 180, 270}, {10, 30, 200}, {0, 60, 120}, {5, 8, 300}}};

TEST(InterfaceNetwork, BodiesRoundPlaneJunctionsAreExact) {
  std::mt19937_64 random(1);
  for (const auto& degrees : kJunctions) {
    const Junction junction(degrees);
    const InterfaceNetwork network(junction.mesh, Box3{{-9, -9, 0}, {9, 9, 1}});
    ASSERT_EQ(network.table().body_count(), 3u);
    ASSERT_EQ(network.table().interface_count(), 3u);
    for (int i = 0; i < 3000; ++i) {
      const double reach = std::pow(10.0, -(i % 5));
      const Vec3 p = random_point(
          random, {{0.5 - 0.5 * reach, 0.5 - 0.5 * reach, 0}, {0.5 + 0.5 * reach, 0.5 + 0.5 * reach, 1}});
      EXPECT_EQ(network.table().material(network.body_at(p)).value, junction.region(p));
    }
  }
}

TEST(InterfaceNetwork, SignedDistancesContinuePlanes) {
  std::mt19937_64 random(2);
  std::vector<NearInterface> found;
  for (const auto& degrees : kJunctions) {
    const Junction junction(degrees);
    const InterfaceNetwork network(junction.mesh, Box3{{-9, -9, 0}, {9, 9, 1}});
    for (int i = 0; i < 1000; ++i) {
      const Vec3 p = random_point(random, test::unit_box());
      const double radius = 0.05 + 0.5 * random_point(random, test::unit_box()).x;
      const BodyId body = network.body_at(p);
      const MaterialId material = network.table().material(body);
      network.near_interfaces(p, radius, body, found);
      std::size_t expected = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 offset = p - Vec3{0.5, 0.5, p.z};
        const double along = dot(offset, junction.directions[k]);
        const double height = dot(offset, cross(junction.directions[k], {0, 0, 1}));
        const double d = along < 0 ? norm(offset) : std::abs(height);
        if (std::abs(d - radius) < 1e-12) continue;
        const MaterialId front((k + 2) % 3), back(k);
        const auto at = std::find_if(found.begin(), found.end(), [&](const NearInterface& n) {
          const auto& side = network.table().sides(n.interface);
          const MaterialId x = network.table().material(side[0]), y = network.table().material(side[1]);
          return (x == front && y == back) || (x == back && y == front);
        });
        ASSERT_EQ(at != found.end(), d < radius);
        if (at == found.end()) continue;
        ++expected;
        double value = height;
        if (material == front && value < 0) value = d;
        if (material == back && value > 0) value = -d;
        if (network.table().material(network.table().sides(at->interface)[0]) != front) value = -value;
        EXPECT_NEAR(at->signed_distance, value, 1e-12);
        EXPECT_NEAR(distance(at->closest, p), d, 1e-12);
      }
      EXPECT_EQ(found.size(), expected);
    }
  }
}

/// Compares materials with the rule that defines the scene, for points farther than `margin` from its
/// interfaces.
void compare_with_scene(const std::string& name, std::uint64_t seed, double resolution, double margin) {
  const Scene scene = make_scene(name, seed);
  const InterfaceMesh mesh = scene_interfaces(scene, resolution);
  const InterfaceNetwork network(mesh, scene.box());
  EXPECT_EQ(network.inconsistencies(), 0u) << name << seed;
  std::mt19937_64 random(seed + 3);
  int compared = 0;
  for (int i = 0; i < 4000; ++i) {
    Vec3 p = random_point(random, scene.box());
    if (i % 2 == 1) {  // close to a corner of the mesh
      const auto pick = static_cast<std::size_t>(random() % mesh.points.size());
      p = mesh.points[pick] + std::pow(10.0, -i % 7) * (p - scene.box().center());
      if (!scene.box().contains(p)) continue;
    }
    if (network.tree().closest(p, margin)) continue;
    ++compared;
    bool flagged = true;
    const MaterialId found = network.table().material(network.body_at(p, &flagged));
    EXPECT_EQ(found, scene.owner(p)) << name << " " << seed << ": " << p.x << " " << p.y << " " << p.z;
    EXPECT_FALSE(flagged) << name << " " << seed << ": " << p.x << " " << p.y << " " << p.z;
  }
  EXPECT_GT(compared, 1000) << name;
}

TEST(InterfaceNetwork, MaterialsOfScenesAreFound) {
  for (const char* name : {"tjunction", "reflex", "plate"}) compare_with_scene(name, 0, 0.1, 1e-9);
  for (const char* name : {"sphere", "shell2", "shell3"}) compare_with_scene(name, 0, 0.05, 0.01);
  for (std::uint64_t seed = 0; seed < 4; ++seed) compare_with_scene("voronoi10", seed, 0.1, 1e-9);
}

TEST(LongInterfaceNetwork, MaterialsOfManyRandomPartitionsAreFound) {
  for (std::uint64_t seed = 100; seed < 115; ++seed) compare_with_scene("voronoi10", seed, 0.07, 1e-9);
  for (std::uint64_t seed = 0; seed < 25; ++seed) compare_with_scene("random", seed, 0.04, 0.02);
}

TEST(InterfaceNetwork, DistancesAreExactInsideSheets) {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  const Vec3 center{0.5, 0.5, 0.5};
  test::add_sphere(mesh, center, 0.4, kA, kB, 30);
  test::add_sphere(mesh, center, 0.2, kB, kC, 30);
  const InterfaceNetwork network(mesh, test::unit_box());
  std::mt19937_64 random(5);
  std::vector<NearInterface> found, vertices;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_point(random, test::unit_box());
    const double r = distance(p, center);
    const BodyId body = network.body_at(p);
    if (std::abs(r - 0.4) > 0.005 && std::abs(r - 0.2) > 0.005) {
      EXPECT_EQ(network.table().material(body).value, r > 0.4 ? 0u : (r > 0.2 ? 1u : 2u));
    }
    network.near_interfaces(p, 2, body, found);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_LT(found[0].interface, found[1].interface);
    EXPECT_NEAR(found[0].signed_distance, r - 0.4, 0.005);
    EXPECT_NEAR(found[1].signed_distance, r - 0.2, 0.005);
    network.near_interfaces(p, 2, body, vertices, DistanceMode::kNearestVertex);
    for (std::size_t k = 0; k < 2; ++k) {
      double least = 9;
      for (const std::uint32_t t : {0u, 1u}) {
        const auto& interface = network.interface(found[k].interface);
        for (std::uint32_t n = interface.first; n < interface.first + interface.count; ++n) {
          for (const Vec3& corner : network.triangle_corners(n))
            least = std::min(least, distance(p, corner) + 0 * t);
        }
      }
      EXPECT_NEAR(std::abs(vertices[k].signed_distance), least, 1e-14);
      EXPECT_GE(least, std::abs(found[k].signed_distance) - 1e-14);
    }
    const auto closest = network.tree(body).closest(p);
    ASSERT_TRUE(closest);
    double least = 9;
    for (const NearInterface& n : found) {
      const auto& sides = network.table().sides(n.interface);
      if (sides[0] == body || sides[1] == body) least = std::min(least, std::abs(n.signed_distance));
    }
    EXPECT_NEAR(std::sqrt(closest->squared_distance), least, 1e-14);
    EXPECT_EQ(closest->squared_distance,
              closest_on_triangle(p, network.triangle_corners(closest->triangle)).squared_distance);
  }
}

TEST(InterfaceNetwork, OpenBordersAreFlagged) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_patch(mesh, {0.25, 0.25, 0.5}, {0.5, 0, 0}, {0, 0.5, 0}, kA, kB);
  const InterfaceNetwork network(mesh, test::unit_box());
  bool flagged = true;
  EXPECT_EQ(network.table().material(network.body_at({0.5, 0.5, 0.9}, &flagged)), kA);
  EXPECT_FALSE(flagged);
  EXPECT_EQ(network.table().material(network.body_at({0.4, 0.5, 0.1}, &flagged)), kB);
  EXPECT_FALSE(flagged);
  EXPECT_EQ(network.table().material(network.body_at({0.9, 0.9, 0.9}, &flagged)), kA);
  EXPECT_TRUE(flagged);
  // The border of a sheet that ends at the domain is not an open border.
  InterfaceMesh plane = test::mesh_with_materials(2);
  test::add_patch(plane, {0, 0, 0}, {1, 0, 0.5}, {0, 1, 0}, kA, kB);
  EXPECT_EQ(InterfaceNetwork(plane, test::unit_box()).body_at({0.99, 0.5, 0.9}, &flagged).value, 0u);
  EXPECT_FALSE(flagged);
}

TEST(InterfaceNetwork, TouchingConesAreToldApart) {
  // Two cones of b touch at their tips, where the pseudonormals of the two cancel.
  InterfaceMesh mesh = test::mesh_with_materials(2);
  mesh.points.push_back({0.5, 0.5, 0.5});
  for (const double z : {0.0, 1.0}) {
    const auto base = static_cast<std::uint32_t>(mesh.points.size());
    for (int k = 0; k < 12; ++k)
      mesh.points.push_back({0.5 + 0.25 * std::cos(k * M_PI / 6), 0.5 + 0.25 * std::sin(k * M_PI / 6), z});
    for (std::uint32_t k = 0; k < 12; ++k) {
      mesh.triangles.push_back({{0, base + k, base + (k + 1) % 12}, z > 0 ? kB : kA, z > 0 ? kA : kB});
    }
  }
  const InterfaceNetwork network(mesh, test::unit_box());
  EXPECT_EQ(network.table().body_count(), 3u);
  std::mt19937_64 random(6);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = random_point(random, test::unit_box());
    const double r = std::hypot(p.x - 0.5, p.y - 0.5), cone = 0.5 * std::abs(p.z - 0.5);
    if (r > 0.96 * cone && r < 1.04 * cone) continue;
    EXPECT_EQ(network.table().material(network.body_at(p)), r < cone ? kB : kA);
  }
}

TEST(InterfaceNetwork, ManyInterfacesAreFoundInOrder) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      for (int k = 0; k < 6; ++k)
        test::add_sphere(mesh, {(i + 0.5) / 6, (j + 0.5) / 6, (k + 0.5) / 6}, 0.06, kA, kB, 4);
    }
  }
  const InterfaceNetwork network(mesh, test::unit_box());
  ASSERT_EQ(network.table().interface_count(), 216u);
  std::mt19937_64 random(7);
  std::vector<NearInterface> found;
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random_point(random, test::unit_box());
    const double radius = random_point(random, test::unit_box()).x;
    const BodyId body = network.body_at(p);
    network.near_interfaces(p, radius, body, found);
    std::size_t next = 0;
    for (InterfaceId id(0); id.value < network.table().interface_count(); ++id.value) {
      const auto closest = network.tree(id).closest(p);
      if (std::sqrt(closest->squared_distance) > radius) continue;
      ASSERT_LT(next, found.size());
      EXPECT_EQ(found[next].interface, id);
      EXPECT_EQ(std::abs(found[next].signed_distance), std::sqrt(closest->squared_distance));
      EXPECT_EQ(found[next].signed_distance < 0, body == network.table().sides(id)[1]);
      ++next;
    }
    EXPECT_EQ(next, found.size());
  }
}

TEST(InterfaceNetwork, TreesHaveTheTrianglesOfTheirBodiesAndMaterials) {
  // Three balls of two materials, one inside of another, in a third material.
  InterfaceMesh mesh = test::mesh_with_materials(3);
  const MaterialId c(2);
  test::add_sphere(mesh, {0.3, 0.3, 0.3}, 0.25, kA, kB, 6);
  test::add_sphere(mesh, {0.3, 0.3, 0.3}, 0.1, kB, c, 5);
  test::add_sphere(mesh, {0.7, 0.7, 0.7}, 0.2, kA, c, 7);
  const InterfaceNetwork network(mesh, test::unit_box());
  const InterfaceTable& table = network.table();
  ASSERT_EQ(table.body_count(), 4u);
  const auto triangles_with = [&](const auto& is_side) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
      const auto& [first, second] = table.sides(network.interface_of(t));
      if (is_side(first) || is_side(second)) found.push_back(t);
    }
    return found;
  };
  for (BodyId b(0); b.value < table.body_count(); ++b.value)
    EXPECT_EQ(network.tree(b).indices(), triangles_with([&](BodyId side) { return side == b; }));
  for (MaterialId m(0); m.value < 3; ++m.value)
    EXPECT_EQ(network.tree(m).indices(),
              triangles_with([&](BodyId side) { return table.material(side) == m; }));
}

TEST(InterfaceNetwork, TakesKnownBodiesAndChecksThem) {
  const Junction junction(kJunctions[0]);
  const Box3 box{{-9, -9, 0}, {9, 9, 1}};
  const Bodies bodies = find_bodies(junction.mesh, &box);
  const InterfaceNetwork network(junction.mesh, box, bodies);
  std::multiset<std::pair<BodyId, BodyId>> given, kept;
  for (const auto& sides : bodies.sides) given.insert(std::minmax(sides[0], sides[1]));
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& interface = network.interface(network.interface_of(t));
    kept.insert({interface.a, interface.b});
    const auto& c = network.triangle_corners(t);
    const Vec3 outside = (1.0 / 3) * (c[0] + c[1] + c[2]) + 1e-3 * network.normal(t);
    EXPECT_EQ(network.body_at(outside), interface.a);
  }
  EXPECT_EQ(kept, given);
  Bodies wrong = bodies;
  wrong.sides.pop_back();
  EXPECT_THROW(InterfaceNetwork(junction.mesh, box, wrong), Error);
  wrong = bodies;
  wrong.sides[0][0] = BodyId(17);
  EXPECT_THROW(InterfaceNetwork(junction.mesh, box, wrong), Error);
  const InterfaceNetwork nothing(test::mesh_with_materials(1), box);
  EXPECT_EQ(nothing.body_at({0, 0, 0}), BodyId(0));
}

}  // namespace
}  // namespace adamas
