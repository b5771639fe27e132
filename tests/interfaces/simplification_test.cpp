#include <algorithm>
#include <set>
#include <tuple>

#include "core/base/parallel.h"
#include "interfaces/network/body_topology.h"
#include "interfaces/network/edge_fans.h"
#include "interfaces/network/interface_mesh_check.h"
#include "interfaces/network/network_measures.h"
#include "interfaces/network/triangle_contacts.h"
#include "tests/interfaces/simplification_scenes.h"
#include "tests/support/closed_surface.h"

namespace adamas {

using namespace interfaces;

namespace {

using test::corners_of;
using test::simplification;

struct Case {
  std::string scene;
  std::size_t cells;
  std::uint64_t seed;
  double error;
  bool lines, smooth;
};

std::string name_of(const testing::TestParamInfo<Case>& info) {
  return fmt::format("{}{}_{}_{}{}{}", info.param.scene, info.param.cells, info.param.seed, info.index,
                     info.param.lines ? "" : "_locked", info.param.smooth ? "_smooth" : "");
}

class SimplifiedScene : public testing::TestWithParam<Case> {
 protected:
  SimplifiedScene()
      : source_(test::reconstructed_scene(GetParam().scene, GetParam().cells, GetParam().seed)),
        before_(test::interfaces_of(source_)),
        after_(simplify_interfaces(source_,
                                   simplification(GetParam().error, GetParam().lines, GetParam().smooth))) {}

  void expect_within_the_error() const;
  void expect_the_same_bodies() const;
  void expect_volumes_within_a_shell() const;
  void expect_known_points() const;

  ResamplingSource source_;
  InterfaceMesh before_;
  SimplifiedNetwork after_;
};

/// Samples the distance both ways, by another method than the certificate.
void SimplifiedScene::expect_within_the_error() const {
  const double error = GetParam().error;
  EXPECT_LE(after_.certificate.networks.upper, error);
  EXPECT_LE(after_.certificate.materials.upper, error);
  if (after_.certificate.junctions) {
    EXPECT_LE(after_.certificate.junctions->upper, error);
  }
  EXPECT_LT(2 * after_.mesh.triangles.size(), before_.triangles.size());
  for (MaterialId m(0); m.value < source_.materials.size(); ++m.value) {
    const auto a = test::boundary_of(before_, m), b = test::boundary_of(after_.mesh, m);
    ASSERT_EQ(a.empty(), b.empty());
    if (a.empty()) continue;
    EXPECT_LE(test::sampled_distance(before_.points, a, after_.mesh.points, b, source_.box, 3000, 7),
              after_.certificate.materials.upper * (1 + 1e-12));
  }
}

void SimplifiedScene::expect_the_same_bodies() const {
  const InterfaceMeshReport report = check_interface_mesh(after_.mesh, &source_.box);
  EXPECT_EQ(report.open_border_edges, 0u);
  EXPECT_EQ(report.degenerate_triangles, 0u);
  EXPECT_EQ(after_.changed_bodies, 0u);
  EXPECT_TRUE(find_contacts(after_.mesh).empty());
  const auto edges = test::check_edges(after_.mesh.points, test::sided_by_material(after_.mesh), source_.box,
                                       1e-9 * source_.box.diagonal());
  EXPECT_EQ(edges.open, 0u) << edges.first;
  EXPECT_EQ(edges.degenerate, 0u);
  // The bodies are found anew, without what was known of them.
  const InterfaceNetwork network(after_.mesh, source_.box);
  EXPECT_EQ(network.table().body_count(), source_.network->table().body_count());
  EXPECT_EQ(network.table().interface_count(), source_.network->table().interface_count());
}

void SimplifiedScene::expect_volumes_within_a_shell() const {
  const InterfaceNetwork network(after_.mesh, source_.box);
  const auto before = measure_network(*source_.network, source_.box, source_.materials.size());
  const auto after = measure_network(network, source_.box, source_.materials.size());
  double area = 0;
  for (const double a : before.areas) area += a;
  for (MaterialId m(0); m.value < source_.materials.size(); ++m.value)
    EXPECT_NEAR(after.volumes[m], before.volumes[m], GetParam().error * area);
}

void SimplifiedScene::expect_known_points() const {
  std::set<std::tuple<double, double, double>> known;
  for (const Vec3& p : before_.points) known.insert({p.x, p.y, p.z});
  for (const Vec3& p : after_.mesh.points) {
    const bool inside = p.x > source_.box.min.x && p.x < source_.box.max.x && p.y > source_.box.min.y &&
                        p.y < source_.box.max.y && p.z > source_.box.min.z && p.z < source_.box.max.z;
    if (inside && GetParam().smooth) continue;
    EXPECT_TRUE(known.contains({p.x, p.y, p.z}));
  }
}

/// All laws are checked in one test, since the simplification takes long.
TEST_P(SimplifiedScene, KeepsTheLaws) {
  expect_within_the_error();
  expect_the_same_bodies();
  expect_volumes_within_a_shell();
  expect_known_points();
}

INSTANTIATE_TEST_SUITE_P(
    All, SimplifiedScene,
    testing::Values(Case{"sphere", 12, 0, 0.02, true, false}, Case{"sphere", 12, 0, 0.02, true, true},
                    Case{"plate", 10, 0, 0.02, true, false}, Case{"tjunction", 10, 0, 0.02, true, false},
                    Case{"tjunction", 10, 0, 0.02, false, false}, Case{"shell3", 10, 0, 0.01, true, false},
                    Case{"voronoi10", 8, 3, 0.03, true, true}, Case{"voronoi10", 8, 4, 0.02, false, false},
                    Case{"random", 8, 1, 0.02, true, false}, Case{"random", 8, 2, 0.04, true, true},
                    Case{"random", 8, 3, 0.02, true, false}, Case{"random", 8, 4, 0.08, true, false}),
    name_of);

/// Points where interfaces end stay, and all edges between them, unless lines may be shortened.
TEST(Simplification, LeavesLinesAloneUnlessAsked) {
  const ResamplingSource source = test::reconstructed_scene("voronoi10", 8, 5);
  const InterfaceMesh before = test::interfaces_of(source);
  const InterfaceMesh locked = simplify_interfaces(source, simplification(0.02, false)).mesh;
  const InterfaceMesh shortened = simplify_interfaces(source, simplification(0.02, true)).mesh;
  const auto lines = [](const InterfaceMesh& mesh) {
    std::set<std::array<std::array<double, 3>, 2>> result;
    for (const auto& [a, b] : junction_lines(mesh)) {
      const Vec3 &p = mesh.points[a], &q = mesh.points[b];
      const std::array<double, 3> first{p.x, p.y, p.z}, second{q.x, q.y, q.z};
      result.insert({std::min(first, second), std::max(first, second)});
    }
    return result;
  };
  EXPECT_EQ(lines(locked), lines(before));
  EXPECT_LT(2 * lines(shortened).size(), lines(before).size());
  EXPECT_LT(2 * shortened.triangles.size(), locked.triangles.size());
}

TEST(Simplification, IsTheSameOnAnyNumberOfThreads) {
  const ResamplingSource source = test::reconstructed_scene("random", 7, 6);
  std::vector<SimplifiedNetwork> found;
  for (const unsigned threads : {1u, 2u, 2u}) {
    set_thread_limit(threads);
    found.push_back(simplify_interfaces(source, simplification(0.02, true, true)));
  }
  set_thread_limit(0);
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_EQ(found[i].mesh.points, found[0].mesh.points);
    EXPECT_EQ(found[i].mesh.triangles, found[0].mesh.triangles);
    EXPECT_EQ(found[i].certificate.networks.upper, found[0].certificate.networks.upper);
  }
}

/// A plane between two materials needs two triangles, whatever its size.
TEST(Simplification, LeavesTwoTrianglesOfAPlane) {
  InterfaceMesh mesh;
  mesh.source = "plane";
  mesh.materials = {"a", "b"};
  const std::uint32_t n = 20;
  for (std::uint32_t i = 0; i <= n; ++i) {
    for (std::uint32_t j = 0; j <= n; ++j) mesh.points.push_back({1.0 * i / n, 1.0 * j / n, 0.5});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({{a, b, b + 1}, MaterialId(0), MaterialId(1)});
      mesh.triangles.push_back({{a, b + 1, a + 1}, MaterialId(0), MaterialId(1)});
    }
  }
  IdVector<BodyId, MaterialId> materials{MaterialId(0), MaterialId(1)};
  const ResamplingSource source = source_of_interfaces(
      mesh, {{0, 0, 0}, {1, 1, 1}},
      std::vector<std::array<BodyId, 2>>(mesh.triangles.size(), {BodyId(0), BodyId(1)}), materials);
  const SimplifiedNetwork found = simplify_interfaces(source, simplification(0.01));
  EXPECT_EQ(found.mesh.triangles.size(), 2u);
  EXPECT_LE(found.certificate.networks.upper, 1e-4) << "less is not told apart";
  EXPECT_GT(found.smallest_angle, 44);
}

TEST(Simplification, SmoothingMakesAnglesNoSmaller) {
  const ResamplingSource source = test::reconstructed_scene("sphere", 16);
  const auto plain = simplify_interfaces(source, simplification(0.01));
  const auto smooth = simplify_interfaces(source, simplification(0.01, true, true));
  const auto mean_angle = [](const InterfaceMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
      double least = 180;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& p = mesh.points[t.points[i]];
        const Vec3 a = mesh.points[t.points[(i + 1) % 3]] - p, b = mesh.points[t.points[(i + 2) % 3]] - p;
        least = std::min(least, std::atan2(norm(cross(a, b)), dot(a, b)));
      }
      sum += least;
    }
    return sum / static_cast<double>(mesh.triangles.size());
  };
  EXPECT_EQ(smooth.mesh.triangles.size(), plain.mesh.triangles.size());
  EXPECT_GE(smooth.smallest_angle, plain.smallest_angle);
  EXPECT_GT(mean_angle(smooth.mesh), mean_angle(plain.mesh));
}

TEST(Simplification, LeavesTrianglesInContactAlone) {
  // Two spheres cross: their rings of crossing triangles stay, and the other triangles become fewer.
  InterfaceMesh mesh = test::interfaces_of(test::reconstructed_scene("sphere", 10));
  const std::size_t points = mesh.points.size(), triangles = mesh.triangles.size();
  mesh.materials.push_back("other");
  for (std::size_t i = 0; i < points; ++i) mesh.points.push_back(mesh.points[i] + Vec3{0.21, 0.013, 0.007});
  std::vector<std::array<BodyId, 2>> sides;
  for (std::size_t t = 0; t < triangles; ++t) sides.push_back({BodyId(0), BodyId(1)});
  for (std::size_t t = 0; t < triangles; ++t) {
    InterfaceTriangle moved = mesh.triangles[t];
    for (std::uint32_t& p : moved.points) p += static_cast<std::uint32_t>(points);
    moved.front = MaterialId(0), moved.back = MaterialId(2);
    mesh.triangles[t].front = MaterialId(0), mesh.triangles[t].back = MaterialId(1);
    mesh.triangles.push_back(moved);
    sides.push_back({BodyId(0), BodyId(2)});
  }
  IdVector<BodyId, MaterialId> materials{MaterialId(0), MaterialId(1), MaterialId(2)};
  const ResamplingSource source =
      source_of_interfaces(mesh, {{0, 0, 0}, {2, 1, 1}}, std::move(sides), materials);
  const std::size_t before = find_contacts(test::interfaces_of(source)).size();
  ASSERT_GT(before, 0u);
  const SimplifiedNetwork found = simplify_interfaces(source, simplification(0.03));
  EXPECT_EQ(found.contacts, before);
  EXPECT_LT(2 * found.mesh.triangles.size(), mesh.triangles.size());
}

}  // namespace
}  // namespace adamas
