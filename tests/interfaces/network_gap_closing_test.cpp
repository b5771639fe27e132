#include <gtest/gtest.h>

#include <numeric>
#include <optional>

#include "interfaces/network/check.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/network/mending.h"
#include "interfaces/network/network_measures.h"
#include "tests/interfaces/mending_meshes.h"

namespace adamas {

using namespace interfaces;

namespace {

using test::Closed, test::Piece, test::changes, test::closed_meshes, test::expect_same, test::pieces;
using test::random_point;

const MaterialId kA(0), kB(1);

/// Every triangle with points of its own, moved at random by at most `reach` along each axis.
InterfaceMesh torn_apart(const InterfaceMesh& whole, double reach, std::mt19937_64& random) {
  InterfaceMesh mesh = whole;
  mesh.points.clear();
  for (InterfaceTriangle& t : mesh.triangles) {
    for (std::uint32_t& p : t.points) {
      const Vec3 at =
          whole.points[p] + 2 * reach * (random_point(random, test::unit_box()) - Vec3{0.5, 0.5, 0.5});
      p = static_cast<std::uint32_t>(mesh.points.size());
      mesh.points.push_back(at);
    }
  }
  return mesh;
}

TEST(GapClosing, GapsBelowTheToleranceAreClosed) {
  std::mt19937_64 random(3);
  for (const Closed& closed : closed_meshes()) {
    InterfaceMesh mesh = torn_apart(closed.mesh, 1e-7 * closed.box.diagonal(), random);
    ASSERT_GT(check_interface_mesh(mesh, &closed.box, {true, true}).open_border_edges, 0u);
    const InterfaceMending mending = mend_interface_mesh(mesh, &closed.box);
    EXPECT_GT(mending.gaps.welded_points.count, 0u);
    const auto report = check_interface_mesh(mesh, &closed.box);
    const auto expected = check_interface_mesh(closed.mesh, &closed.box);
    EXPECT_EQ(report.open_border_edges, 0u);
    EXPECT_EQ(report.points, expected.points);
    EXPECT_EQ(report.domain_edges, expected.domain_edges);
    EXPECT_EQ(report.junction_edges, expected.junction_edges);
    const InterfaceNetwork whole(closed.mesh, closed.box), mended(mesh, closed.box);
    ASSERT_EQ(mended.table().body_count(), whole.table().body_count());
    const std::size_t materials = mesh.materials.size();
    const auto volumes = measure_network(mended, closed.box, materials).volumes;
    const auto truth = measure_network(whole, closed.box, materials).volumes;
    for (MaterialId m(0); m.value < materials; ++m.value)
      EXPECT_NEAR(volumes[m], truth[m], 1e-6 * closed.box.volume());
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = random_point(random, closed.box);
      if (whole.tree().closest(p, 1e-5)) continue;
      EXPECT_EQ(mended.table().material(mended.body_at(p)), whole.table().material(whole.body_at(p)));
    }
  }
}

TEST(GapClosing, WiderGapsStayOpen) {
  std::mt19937_64 random(4);
  InterfaceMesh mesh = test::mesh_with_materials(2);
  test::add_sphere(mesh, {0.5, 0.5, 0.5}, 0.4, kA, kB);
  const Box3 box = test::unit_box();
  mesh = torn_apart(mesh, 1e-3, random);
  const InterfaceMesh before = mesh;
  EXPECT_EQ(changes(mend_interface_mesh(mesh, &box, {1e-7, false})), 0u);
  expect_same(mesh, before);
  EXPECT_EQ(changes(mend_interface_mesh(mesh, &box, {0, false})), 0u);
  mend_interface_mesh(mesh, &box, {4e-3, false});
  EXPECT_EQ(check_interface_mesh(mesh, &box).open_border_edges, 0u);
}

TEST(GapClosing, BordersFinerThanTheToleranceAreNotFolded) {
  // A fan whose outer border has two edges that are shorter than gaps that are closed; no box cuts it.
  InterfaceMesh mesh = test::mesh_with_materials(2);
  mesh.points = {{-1, 0, 0}, {0, -1, 0}, {0, -1e-7, 2e-8}, {0, 0, 0}, {0, 1e-7, 0}, {0, 1, 0}};
  for (std::uint32_t p = 1; p < 5; ++p) mesh.triangles.push_back({{0, p, p + 1}, kA, kB});
  const InterfaceMesh before = mesh;
  EXPECT_EQ(changes(mend_interface_mesh(mesh, nullptr)), 0u);
  expect_same(mesh, before);
}

TEST(GapClosing, EdgesAreSplitWhereOthersEndOnThem) {
  // A sheet of strips whose points do not match, across the domain.
  const Box3 box = test::unit_box();
  InterfaceMesh mesh = test::mesh_with_materials(2);
  std::mt19937_64 random(5);
  for (std::uint32_t strip = 0; strip < 5; ++strip)
    test::add_patch(mesh, {0.2 * strip, 0, 0.5}, {0.2, 0, 0.04}, {0, 1, 0}, kA, kB, 2 + strip * strip % 7);
  for (Vec3& p : mesh.points) p.z = 0.5 + 0.1 * p.x;
  ASSERT_GT(check_interface_mesh(mesh, &box, {true, true}).open_border_edges, 20u);
  const InterfaceMending mending = mend_interface_mesh(mesh, &box);
  EXPECT_GT(mending.gaps.split_edges.count, 5u);
  EXPECT_EQ(check_interface_mesh(mesh, &box).open_border_edges, 0u);
  const InterfaceNetwork network(mesh, box);
  EXPECT_NEAR(measure_network(network, box, 2).volumes[kA], 0.45, 1e-9);
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = random_point(random, box);
    bool flagged = true;
    EXPECT_EQ(network.table().material(network.body_at(p, &flagged)), p.z > 0.5 + 0.1 * p.x ? kA : kB);
    EXPECT_FALSE(flagged);
  }
}

/// The same mesh with its triangles and points in another order.
InterfaceMesh shuffled(const InterfaceMesh& mesh, std::mt19937_64& random) {
  std::vector<std::uint32_t> place(mesh.points.size());
  std::iota(place.begin(), place.end(), 0u);
  std::shuffle(place.begin(), place.end(), random);
  InterfaceMesh other = mesh;
  for (std::size_t p = 0; p < place.size(); ++p) other.points[place[p]] = mesh.points[p];
  for (InterfaceTriangle& t : other.triangles) {
    for (std::uint32_t& p : t.points) p = place[p];
  }
  std::shuffle(other.triangles.begin(), other.triangles.end(), random);
  return other;
}

/// Triangles between points of a small lattice, some a little off it, so that many coincide or nearly do.
InterfaceMesh lattice_soup(std::mt19937_64& random) {
  InterfaceMesh mesh = test::mesh_with_materials(4);
  const std::size_t count = 1 + random() % 60, side = 2 + random() % 2;
  const double off = random() % 2 == 0 ? 0 : 1e-7;
  for (std::size_t t = 0; t < count; ++t) {
    for (int k = 0; k < 3; ++k) {
      Vec3 p;
      for (int axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(random() % side) / 2;
      mesh.points.push_back(p + off * random_point(random, test::unit_box()));
    }
    const auto first = static_cast<std::uint32_t>(3 * t);
    const MaterialId front(random() % 4), back((front.value + 1 + random() % 3) % 4);
    mesh.triangles.push_back({{first, first + 1, first + 2}, front, back});
  }
  return mesh;
}

TEST(Mending, AnySoupIsMendedAlikeWhateverItsOrder) {
  std::mt19937_64 random(6);
  const Box3 box{{-0.5, -0.5, -0.5}, {1.5, 1.5, 1.5}};
  std::size_t mended = 0, refused = 0;
  for (int round = 0; round < 100; ++round) {
    const InterfaceMesh soup = lattice_soup(random);
    for (const bool tolerant : {false, true}) {
      std::array<std::optional<std::multiset<Piece>>, 2> results;
      for (std::size_t i = 0; i < 2; ++i) {
        InterfaceMesh mesh = i == 0 ? soup : shuffled(soup, random);
        try {
          mend_interface_mesh(mesh, &box, {1e-6, tolerant});
          results[i] = pieces(mesh);
        } catch (const TolerableFault&) {
          EXPECT_FALSE(tolerant);
          continue;
        }
        if (mesh.triangles.empty()) continue;
        const InterfaceNetwork network(mesh, box);
        if (network.table().body_count() == 0) continue;
        for (int k = 0; k < 5; ++k)
          EXPECT_LT(network.body_at(random_point(random, box)).value, network.table().body_count());
      }
      ++(results[0] ? mended : refused);
      EXPECT_EQ(results[0], results[1]) << "round " << round << (tolerant ? " tolerant" : "");
    }
  }
  EXPECT_GT(mended, 100u);
  EXPECT_GT(refused, 25u);
}

}  // namespace
}  // namespace adamas
