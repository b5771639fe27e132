#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/geometry/place_text.h"
#include "interfaces/network/check.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/network/mending.h"
#include "interfaces/network/network_measures.h"
#include "tests/interfaces/mending_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

using test::Closed, test::changes, test::closed_meshes, test::expect_same, test::pieces;
using test::random_point;
using ::testing::HasSubstr;

const MaterialId kA(0), kB(1), kC(2);

void turn_over(InterfaceTriangle& t) { std::swap(t.points[1], t.points[2]); }

TEST(Mending, SoundMeshesStayAsTheyAre) {
  for (const Closed& closed : closed_meshes()) {
    InterfaceMesh mesh = closed.mesh;
    EXPECT_EQ(changes(mend_interface_mesh(mesh, &closed.box)), 0u) << mesh.source;
    expect_same(mesh, closed.mesh);
  }
}

TEST(Mending, TurnedTrianglesAreTurnedBack) {
  std::mt19937_64 random(1);
  for (const Closed& closed : closed_meshes()) {
    for (int round = 0; round < 4; ++round) {
      InterfaceMesh mesh = closed.mesh;
      std::size_t turned = 0;
      const Vec3 middle = random_point(random, closed.box);
      for (InterfaceTriangle& t : mesh.triangles) {
        // Patches, which cross from one interface to others, and single triangles.
        const bool near = distance(mesh.points[t.points[0]], middle) < 0.1 * closed.box.diagonal();
        if (round % 2 == 0 ? !near : random() % 16 != 0) continue;
        turn_over(t);
        ++turned;
      }
      const InterfaceMending mending = mend_interface_mesh(mesh, &closed.box);
      EXPECT_EQ(mending.turned.count, turned) << mesh.source << " " << round;
      EXPECT_EQ(changes(mending), turned);
      expect_same(mesh, closed.mesh);
    }
  }
}

TEST(Mending, WholeSheetsAreTurnedWhereOthersTellTheirSides) {
  // Two caps of a sphere and a disc between them; which way each goes follows from the other two.
  InterfaceMesh whole = test::mesh_with_materials(3);
  test::add_sphere(whole, {0.5, 0.5, 0.5}, 0.4, kA, kB);
  const auto center = static_cast<std::uint32_t>(whole.points.size());
  whole.points.push_back({0.5, 0.5, 0.5});
  for (InterfaceTriangle& t : whole.triangles) {
    double height = 0;
    for (const std::uint32_t p : t.points) height += whole.points[p].z - 0.5;
    if (height < 0) t.back = kC;
  }
  for (std::uint32_t j = 0; j < 24; ++j)
    whole.triangles.push_back({{center, 1 + 5 * 24 + j, 1 + 5 * 24 + (j + 1) % 24}, kB, kC});
  ASSERT_EQ(check_interface_mesh(whole, nullptr).open_border_edges, 0u);
  for (const auto& [front, back] : {std::pair(kA, kB), std::pair(kA, kC), std::pair(kB, kC)}) {
    InterfaceMesh mesh = whole;
    for (InterfaceTriangle& t : mesh.triangles) {
      if (t.front == front && t.back == back) turn_over(t);
    }
    EXPECT_GT(mend_interface_mesh(mesh, nullptr).turned.count, 20u);
    expect_same(mesh, whole);
  }
}

TEST(Mending, WhereNothingTellsWhatIsRightNothingIsTurned) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.4, kA, kB);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 2) turn_over(mesh.triangles[t]);
  const InterfaceMesh before = mesh;
  EXPECT_EQ(mend_interface_mesh(mesh, nullptr).turned.count, 0u);
  expect_same(mesh, before);
  EXPECT_THROW(check_interface_mesh(mesh, nullptr), TolerableFault);
  // A Moebius strip has no sides.
  InterfaceMesh strip = test::mesh_with_materials(2);
  constexpr std::uint32_t kSteps = 20;
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const double angle = 2 * M_PI * i / kSteps;
    for (const double s : {-0.1, 0.1}) {
      const double r = 0.4 + s * std::cos(angle / 2);
      strip.points.push_back({r * std::cos(angle), r * std::sin(angle), s * std::sin(angle / 2)});
    }
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1, last = i + 1 == kSteps ? 1 : 0;
    const std::uint32_t c = (a + 2) % (2 * kSteps) + last, d = (a + 2) % (2 * kSteps) + 1 - last;
    strip.triangles.push_back({{a, c, b}, kA, kB});
    strip.triangles.push_back({{b, c, d}, kA, kB});
  }
  EXPECT_EQ(mend_interface_mesh(strip, nullptr).turned.count, 0u);
  EXPECT_THROW(check_interface_mesh(strip, nullptr), TolerableFault);
}

TEST(Mending, DuplicatesCountOnce) {
  std::mt19937_64 random(2);
  for (const Closed& closed : closed_meshes()) {
    InterfaceMesh mesh = closed.mesh;
    constexpr std::size_t kCopies = 40;
    for (std::size_t i = 0; i < kCopies; ++i) {
      InterfaceTriangle copy = closed.mesh.triangles[random() % closed.mesh.triangles.size()];
      std::rotate(copy.points.begin(), copy.points.begin() + i % 3, copy.points.end());
      if (i % 2 == 0) turn_over(copy), std::swap(copy.front, copy.back);
      // Points of its own at the same places.
      for (std::uint32_t& p : copy.points) {
        const Vec3 at = mesh.points[p];
        p = static_cast<std::uint32_t>(mesh.points.size());
        mesh.points.push_back(at);
      }
      mesh.triangles.insert(mesh.triangles.begin() + static_cast<long>(random() % mesh.triangles.size()),
                            copy);
    }
    const InterfaceMending mending = mend_interface_mesh(mesh, &closed.box);
    EXPECT_EQ(mending.coincident.duplicates.count, kCopies);
    EXPECT_EQ(changes(mending), kCopies);
    EXPECT_EQ(pieces(mesh), pieces(closed.mesh));
  }
}

/// Both halves of the unit box's plane z = 0.5, between two materials.
void add_plane(InterfaceMesh& mesh, MaterialId above, MaterialId below) {
  test::add_patch(mesh, {0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}, above, below);
}

TEST(Mending, LayersWithoutThicknessLeaveWhatIsBesideThem) {
  const Box3 box = test::unit_box();
  for (const bool first : {true, false}) {
    InterfaceMesh mesh = test::mesh_with_materials(3), whole = test::mesh_with_materials(3);
    add_plane(mesh, first ? kA : kB, first ? kB : kC);
    add_plane(mesh, first ? kB : kA, first ? kC : kB);
    add_plane(whole, kA, kC);
    const InterfaceMending mending = mend_interface_mesh(mesh, &box);
    EXPECT_EQ(mending.coincident.thin_layers.count, 32u);
    EXPECT_EQ(pieces(mesh), pieces(whole));
  }
}

/// The surface of a box, its normals outwards; equal faces of equal boxes have equal triangles.
void add_box(InterfaceMesh& mesh, const Vec3& origin, double size, MaterialId outside, MaterialId inside) {
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 u, v, w;
    u[axis] = v[(axis + 1) % 3] = w[(axis + 2) % 3] = size;
    test::add_patch(mesh, origin, v, w, inside, outside, 3);
    test::add_patch(mesh, origin + u, v, w, outside, inside, 3);
  }
}

TEST(Mending, PartsThatTouchLoseTheFacesBetweenThem) {
  const Box3 box = test::unit_box();
  InterfaceMesh mesh = test::mesh_with_materials(3);
  add_box(mesh, {0.25, 0.25, 0.25}, 0.25, kA, kB);
  add_box(mesh, {0.5, 0.25, 0.25}, 0.25, kA, kB);
  add_box(mesh, {0.25, 0.25, 0.5}, 0.25, kA, kC);
  const InterfaceMending mending = mend_interface_mesh(mesh, &box);
  EXPECT_EQ(mending.coincident.cancelled.count, 36u);
  EXPECT_EQ(mending.coincident.thin_layers.count, 18u);
  EXPECT_EQ(check_interface_mesh(mesh, &box).open_border_edges, 0u);
  const InterfaceNetwork network(mesh, box);
  EXPECT_EQ(network.table().body_count(), 3u);
  const auto volumes = measure_network(network, box, 3).volumes;
  EXPECT_NEAR(volumes[kB], 2 * 0.015625, 1e-12);
  EXPECT_NEAR(volumes[kC], 0.015625, 1e-12);
}

TEST(Mending, ContradictionsAreRefusedWithTheirPlaces) {
  const auto message = [](const InterfaceMesh& mesh) -> std::string {
    InterfaceMesh copy = mesh;
    try {
      mend_interface_mesh(copy, nullptr);
    } catch (const TolerableFault& fault) {
      return fault.what();
    }
    return "none";
  };
  InterfaceMesh sphere = test::mesh_with_materials(3);
  test::add_sphere(sphere, {0.5, 0.5, 0.5}, 0.4, kA, kB);
  const InterfaceMesh whole = sphere;
  sphere.triangles.push_back(sphere.triangles[100]);
  turn_over(sphere.triangles.back());
  Vec3 place;
  for (const std::uint32_t p : sphere.triangles[100].points) place += (1.0 / 3) * sphere.points[p];
  EXPECT_THAT(message(sphere), HasSubstr(place_text(place)));
  EXPECT_THAT(message(sphere), HasSubstr("opposite faces"));
  const InterfaceMendingOptions tolerant{0, true};
  InterfaceMesh mended = sphere;
  EXPECT_EQ(mend_interface_mesh(mended, nullptr, tolerant).coincident.cancelled.count, 2u);
  EXPECT_EQ(check_interface_mesh(mended, nullptr).open_border_edges, 3u);

  sphere = whole;
  sphere.triangles.push_back(sphere.triangles[100]);
  sphere.triangles.back().back = kC;
  EXPECT_THAT(message(sphere), HasSubstr(place_text(place)));
  EXPECT_THAT(message(sphere), HasSubstr("contradict"));
  EXPECT_EQ(mend_interface_mesh(sphere, nullptr, tolerant).coincident.contradictions.count, 1u);
  expect_same(sphere, whole);
}

}  // namespace
}  // namespace adamas
