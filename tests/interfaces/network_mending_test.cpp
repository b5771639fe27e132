#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "adamas/text.h"
#include "core/base/error.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/network/interface_mesh_check.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/network/mending.h"
#include "interfaces/network/network_measures.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::random_point;
using ::testing::HasSubstr;

const MaterialId kA(0), kB(1), kC(2);

struct Closed {
  InterfaceMesh mesh;
  Box3 box;
};

/// Returns meshes without faults: spheres, sheets that end at the domain, and many triple lines.
std::vector<Closed> closed_meshes() {
  std::vector<Closed> all(1);
  all[0].mesh = test::mesh_with_materials(3);
  test::add_sphere(all[0].mesh, {0.5, 0.5, 0.5}, 0.4, MaterialId(0), MaterialId(1));
  test::add_sphere(all[0].mesh, {0.5, 0.5, 0.5}, 0.2, MaterialId(1), MaterialId(2));
  all[0].box = test::unit_box();
  for (const char* name : {"voronoi10", "tjunction", "plate"}) {
    const Scene scene = make_scene(name, 2);
    all.push_back({scene_interfaces(scene, 0.15), scene.box()});
  }
  return all;
}

using Corner = std::array<double, 3>;
using Piece = std::tuple<std::array<Corner, 3>, MaterialId, MaterialId>;

/// Returns the triangles by their corners; the order and the numbers of points do not matter.
std::multiset<Piece> pieces(const InterfaceMesh& mesh) {
  std::multiset<Piece> all;
  for (const InterfaceTriangle& t : mesh.triangles) {
    std::array<Corner, 3> c;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& p = mesh.points[t.points[i]];
      c[i] = {p.x, p.y, p.z};
    }
    const bool odd = (c[0] > c[1]) != ((c[1] > c[2]) != (c[0] > c[2]));
    std::sort(c.begin(), c.end());
    all.insert(odd ? Piece{c, t.back, t.front} : Piece{c, t.front, t.back});
  }
  return all;
}

void expect_same(const InterfaceMesh& mended, const InterfaceMesh& whole) {
  EXPECT_EQ(mended.points, whole.points);
  EXPECT_EQ(mended.triangles, whole.triangles);
}

std::size_t changes(const InterfaceMending& m) {
  return m.gaps.points_on_faces.count + m.gaps.welded_points.count + m.gaps.split_edges.count +
         m.coincident.duplicates.count + m.coincident.thin_layers.count + m.coincident.cancelled.count +
         m.coincident.contradictions.count + m.turned.count;
}

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
        // Either patches, which extend over several interfaces, or single triangles are turned over.
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
  // There are two caps of a sphere and a disc between them; the orientation of each follows from the other
  // two.
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
      // The copy gets points of its own at the same places.
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

/// Adds the part of the plane z = 0.5 in the unit box, between two materials.
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

/// Adds the surface of a box, its normals outwards. Equal faces of equal boxes have equal triangles.
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

/// Returns the mesh with own points for every triangle, moved at random by at most `reach` along each axis.
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
  // The outer border of a fan has two edges that are shorter than the gaps that are closed; no box cuts the
  // fan.
  InterfaceMesh mesh = test::mesh_with_materials(2);
  mesh.points = {{-1, 0, 0}, {0, -1, 0}, {0, -1e-7, 2e-8}, {0, 0, 0}, {0, 1e-7, 0}, {0, 1, 0}};
  for (std::uint32_t p = 1; p < 5; ++p) mesh.triangles.push_back({{0, p, p + 1}, kA, kB});
  const InterfaceMesh before = mesh;
  EXPECT_EQ(changes(mend_interface_mesh(mesh, nullptr)), 0u);
  expect_same(mesh, before);
}

TEST(GapClosing, EdgesAreSplitWhereOthersEndOnThem) {
  // A sheet across the domain consists of strips whose points do not match.
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

/// Returns the mesh with its triangles and points in another order.
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

/// Returns triangles between points of a small lattice, some a little off it, so that many coincide or nearly
/// do.
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
