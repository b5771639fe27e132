#include <gtest/gtest.h>

#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/network/body_winding.h"
#include "interfaces/network/interface_network.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::random_point;

const MaterialId kA(0), kB(1), kC(2);

/// Returns the area of the triangle's image on the unit sphere, by Girard's theorem from the angles between
/// planes.
double girard(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto angle = [](const Vec3& at, const Vec3& to, const Vec3& from) {
    const Vec3 x = cross(at, to), y = cross(at, from);
    return std::atan2(norm(cross(x, y)), dot(x, y));
  };
  const double excess = angle(a, b, c) + angle(b, c, a) + angle(c, a, b) - M_PI;
  return dot(a, cross(b, c)) > 0 ? excess : -excess;
}

TEST(Winding, SolidAnglesAreThoseOfSphericalTriangles) {
  std::mt19937_64 random(1);
  const Box3 box{{-1, -1, -1}, {1, 1, 1}};
  for (int i = 0; i < 1000; ++i) {
    const Vec3 a = random_point(random, box), b = random_point(random, box), c = random_point(random, box);
    EXPECT_NEAR(solid_angle(a, b, c), girard(a, b, c), 1e-9);
    EXPECT_NEAR(solid_angle(a, 7 * b, c), solid_angle(a, b, c), 1e-12);
  }
  EXPECT_NEAR(solid_angle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}), M_PI / 2, 1e-15);
}

TEST(Winding, TreesAddUpAllTriangles) {
  InterfaceMesh soup = test::random_soup(2, 2000);
  // Triangles without area have no image on the sphere.
  for (std::size_t t = 3; t < soup.triangles.size(); t += 7) soup.triangles[t].points = {0, 0, 0};
  const auto triangles = test::triangles_of(soup);
  const WindingTree tree(soup.points, triangles);
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = random_point(random, {{-1, -1, -1}, {2, 2, 2}});
    double sum = 0;
    for (const auto& t : triangles) {
      if (t[0] == t[1]) continue;
      sum += girard(soup.points[t[0]] - p, soup.points[t[1]] - p, soup.points[t[2]] - p);
    }
    EXPECT_NEAR(tree.at(p), sum / (4 * M_PI), 0.01);
  }
  EXPECT_EQ(WindingTree().at({1, 2, 3}), 0);
}

/// Expects, for closed networks, that each body's winding number is 1 in it and 0 elsewhere, also where
/// sheets end at the domain.
void expect_ones_and_zeros(const InterfaceMesh& mesh, const std::optional<Box3>& domain, const Box3& box) {
  const InterfaceNetwork network(mesh, domain);
  const BodyWinding winding(network, domain);
  std::mt19937_64 random(4);
  IdVector<BodyId, double> numbers;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random_point(random, box);
    if (network.tree().closest(p, 1e-6)) continue;
    const BodyId body = network.body_at(p);
    winding.numbers_at(p, numbers);
    for (BodyId b(0); b.value < numbers.size(); ++b.value)
      EXPECT_NEAR(numbers[b], b == body ? 1 : 0, 0.01) << mesh.source << " body " << b.value;
    EXPECT_EQ(winding.at(p).body, body);
  }
}

TEST(Winding, NumbersOfClosedNetworksTellTheBody) {
  for (const char* name : {"sphere", "shell3", "tjunction", "reflex", "plate", "voronoi10", "random"}) {
    const Scene scene = make_scene(name, 5);
    expect_ones_and_zeros(scene_interfaces(scene, 0.1), scene.box(), scene.box());
  }
  InterfaceMesh mesh = test::mesh_with_materials(3);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.4, kA, kB);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.2, kB, kC);
  expect_ones_and_zeros(mesh, std::nullopt, {{-1, -1, -1}, {2, 2, 2}});
  // Sheets may reach beyond the domain.
  expect_ones_and_zeros(mesh, Box3{{0, 0, 0}, {0.6, 0.55, 1}}, {{0, 0, 0}, {0.6, 0.55, 1}});
}

/// The result of comparing a mesh without some of its triangles with the whole one.
struct Share {
  double wrong, flagged, wrong_unflagged;  ///< parts of all points
};
template <class Missing>
Share compare(const InterfaceMesh& whole, const Box3& box, Missing&& missing) {
  InterfaceMesh torn = whole;
  std::erase_if(torn.triangles, missing);
  const InterfaceNetwork truth(whole, box), network(torn, box);
  EXPECT_TRUE(network.has_open_border());
  std::mt19937_64 random(6);
  constexpr int kPoints = 4000;
  int wrong = 0, flagged = 0, wrong_unflagged = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 p = random_point(random, box);
    bool flag = true;
    const bool differs =
        network.table().material(network.body_at(p, &flag)) != truth.table().material(truth.body_at(p));
    wrong += differs ? 1 : 0;
    flagged += flag ? 1 : 0;
    wrong_unflagged += differs && !flag ? 1 : 0;
  }
  const auto share = [](int n) { return static_cast<double>(n) / kPoints; };
  return {share(wrong), share(flagged), share(wrong_unflagged)};
}

TEST(Winding, MaterialsBesideMissingTrianglesAreFound) {
  std::mt19937_64 random(7);
  const auto at_random = [&random](const InterfaceTriangle&) { return random() % 20 == 0; };
  InterfaceMesh sphere = test::mesh_with_materials(2);
  test::add_sphere(sphere, {0.5, 0.5, 0.5}, 0.4, kA, kB, 20);
  std::vector<std::pair<InterfaceMesh, Box3>> meshes{{sphere, test::unit_box()}};
  for (const char* name : {"shell3", "plate", "random"}) {
    const Scene scene = make_scene(name, 8);
    meshes.emplace_back(scene_interfaces(scene, 0.06), scene.box());
  }
  for (const auto& [mesh, box] : meshes) {
    const Share share = compare(mesh, box, at_random);
    EXPECT_LT(share.wrong, 0.005) << mesh.source;
    EXPECT_LT(share.flagged, 0.03) << mesh.source;
    EXPECT_LT(share.wrong_unflagged, 0.0006) << mesh.source;
  }
}

TEST(Winding, HolesInAFlatFaceAreClosedFlat) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 u, v, w;
    u[axis] = v[(axis + 1) % 3] = w[(axis + 2) % 3] = 0.6;
    test::add_patch(mesh, {0.2, 0.2, 0.2}, v, w, kB, kA, 12);
    test::add_patch(mesh, Vec3{0.2, 0.2, 0.2} + u, v, w, kA, kB, 12);
  }
  const Share share = compare(mesh, test::unit_box(), [&mesh](const InterfaceTriangle& t) {
    Vec3 middle;
    for (const std::uint32_t p : t.points) middle += (1.0 / 3) * mesh.points[p];
    return distance(middle, {0.5, 0.5, 0.8}) < 0.2;
  });
  EXPECT_LT(share.wrong, 0.001);
  EXPECT_EQ(share.wrong_unflagged, 0);
  EXPECT_GT(share.flagged, 0);
}

TEST(Winding, SignsBeyondTheBorderOfASheetAreFlagged) {
  // A disc between a and b ends inside the domain; there are balls of c beside and above it.
  InterfaceMesh mesh = test::mesh_with_materials(3);
  test::add_patch(mesh, {0.3, 0.3, 0.5}, {0.4, 0, 0}, {0, 0.4, 0}, kA, kB);
  test::add_sphere(mesh, {0.85, 0.5, 0.5}, 0.1, kA, kC);
  test::add_sphere(mesh, {0.5, 0.5, 0.7}, 0.1, kA, kC);
  const InterfaceNetwork network(mesh, test::unit_box());
  std::vector<NearInterface> near;
  const auto sheet_at = [&](const Vec3& p) {
    bool flagged = true;
    const BodyId body = network.body_at(p, &flagged);
    EXPECT_FALSE(flagged);
    network.near_interfaces(p, 1, body, near);
    const auto sheet = std::find_if(near.begin(), near.end(), [&](const NearInterface& n) {
      const auto& [a, b] = network.table().sides(n.interface);
      return network.table().material(a) == kA && network.table().material(b) == kB;
    });
    EXPECT_NE(sheet, near.end());
    return *sheet;
  };
  // In a ball the body is certain; the disc's side is not, where the ball lies beyond the disc's border.
  EXPECT_TRUE(sheet_at({0.85, 0.5, 0.52}).flagged);
  EXPECT_FALSE(sheet_at({0.5, 0.5, 0.68}).flagged);
  EXPECT_FALSE(sheet_at({0.5, 0.5, 0.55}).flagged);
  // Beyond the disc's border and outside of the balls the body itself is doubtful.
  bool flagged = false;
  const BodyId beyond = network.body_at({0.5, 0.9, 0.49}, &flagged);
  EXPECT_TRUE(beyond.valid());
  EXPECT_TRUE(flagged);
}

}  // namespace
}  // namespace adamas
