#include "interfaces/probe/probe.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "adamas/probe.h"
#include "core/base/error.h"
#include "tests/interfaces/cross_section_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::make_scene_mesh;
using test::SceneMesh;
using test::SceneMeshOptions;

std::vector<Vec3> random_points(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {unit(random), unit(random), unit(random)};
  return points;
}

/// Returns points inside cells, on their vertices, edges and faces, and on the box.
std::vector<Vec3> trying_points(const ResampledMesh& mesh) {
  std::vector<Vec3> points = random_points(150, 11);
  for (std::size_t cell = 0; cell < mesh.cells.size(); cell += 1 + mesh.cells.size() / 20) {
    const auto x = mesh.corners(cell);
    points.push_back(x[0]);
    points.push_back(0.5 * (x[1] + x[2]));
    points.push_back((1.0 / 3) * (x[1] + x[2] + x[3]));
  }
  for (const double x : {0.0, 0.3, 1.0}) points.push_back({x, 1, 0});
  return points;
}

TEST(Probe, FindsWhatTryingAllCellsFinds) {
  for (const char* name : {"sphere", "plate", "tjunction"}) {
    SceneMeshOptions options;
    options.most = 1500;
    const SceneMesh scene = make_scene_mesh(name, options);
    const auto points = trying_points(scene.mesh);
    const CellLocator locator(scene.mesh);
    const auto samples = probe(scene.mesh, locator, points);
    ASSERT_EQ(samples.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto found = test::find_cell(scene.mesh, points[i]);
      const auto at = locator.locate(points[i]);
      ASSERT_TRUE(at);
      EXPECT_GE(*std::min_element(at->weights.begin(), at->weights.end()), -1e-12);
      EXPECT_TRUE(samples[i].inside());
      EXPECT_EQ(samples[i].point, points[i]);
      EXPECT_EQ(scene.mesh.table.material(BodyId(samples[i].body)).value, samples[i].material);
      // On interfaces the two cells of a shared face may choose different sides.
      const BodyId owner = test::owner_in(scene.mesh, found);
      if (owner.value != samples[i].body) {
        EXPECT_LT(samples[i].interface_distance, 1e-12);
        continue;
      }
      for (std::size_t c = 0; c < samples[i].values.size(); ++c) {
        const double expected = scene.mesh.value(found.cell, owner, c, found.weights);
        EXPECT_TRUE(test::same(samples[i].values[c], expected) ||
                    std::abs(samples[i].values[c] - expected) < 1e-9);
        EXPECT_EQ(std::isnan(expected), c == 5 && samples[i].material != 0);
      }
    }
  }
}

/// The distances of few points are from the interfaces of the cells near them, and are those from all.
TEST(Probe, OfFewPointsIsThatOfMany) {
  SceneMeshOptions options;
  options.error = 0.001;
  options.most = 9000;
  const SceneMesh scene = make_scene_mesh("sphere", options);
  ASSERT_GT(scene.mesh.cells.size(), 4096u);
  std::vector<Vec3> points = trying_points(scene.mesh);
  for (const double x : {-0.2, 0.5, 1.4}) points.push_back({x, 1.3, -0.1});
  points.push_back({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  const auto many = probe(scene.mesh, points);
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const auto few = probe(scene.mesh, std::span<const Vec3>(points).subspan(i, 1));
    EXPECT_TRUE(test::same(few[0].interface_distance, many[i].interface_distance) ||
                std::abs(few[0].interface_distance - many[i].interface_distance) < 1e-10);
    EXPECT_EQ(few[0].body, many[i].body);
    EXPECT_EQ(few[0].material, many[i].material);
  }
}

TEST(Probe, SharedPointsGoToTheFirstCell) {
  const SceneMesh scene = make_scene_mesh("sphere");
  const CellLocator locator(scene.mesh);
  std::vector<std::uint32_t> first(scene.mesh.points.size(), 0xffffffffu);
  for (std::size_t cell = scene.mesh.cells.size(); cell-- > 0;) {
    for (const std::uint32_t v : scene.mesh.cells[cell].vertices) first[v] = static_cast<std::uint32_t>(cell);
  }
  // At a vertex of the cell all weights are exact but one, which makes their sum 1.
  for (std::size_t v = 0; v < first.size(); ++v) {
    const auto at = locator.locate(scene.mesh.points[v]);
    ASSERT_TRUE(at);
    const auto& vertices = scene.mesh.cells[at->cell].vertices;
    EXPECT_NE(std::find(vertices.begin(), vertices.end(), v), vertices.end());
    EXPECT_GE(at->cell, first[v]);
  }
}

TEST(Probe, PointsOutsideAreFlagged) {
  const SceneMesh scene = make_scene_mesh("sphere");
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<Vec3> points{
      {1 + 1e-12, 0.5, 0.5}, {-1, 0, 0}, {nan, 0.5, 0.5}, {0.5, inf, 0.5}, {1, 1, 1}};
  for (const auto& samples : {probe(scene.mesh, points), probe(scene.source, points)}) {
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_FALSE(samples[i].inside());
      EXPECT_EQ(samples[i].material, PointSample::kNoMaterial);
      EXPECT_EQ(samples[i].body, PointSample::kNoBody);
      ASSERT_FALSE(samples[i].values.empty());
      for (const double v : samples[i].values) EXPECT_TRUE(std::isnan(v));
      EXPECT_EQ(std::isnan(samples[i].interface_distance), i >= 2);
    }
    EXPECT_TRUE(samples[4].inside());
  }
  EXPECT_TRUE(probe(scene.mesh, std::vector<Vec3>{}).empty());
}

TEST(Probe, LinearFieldsAndMaterialsOfPlaneScenesAreExact) {
  const SceneMesh scene = make_scene_mesh("tjunction");
  const auto points = random_points(500, 4);
  const auto in_mesh = probe(scene.mesh, points), in_input = probe(scene.source, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const MaterialId owner = scene.scene.owner(points[i]);
    EXPECT_EQ(in_mesh[i].material, owner.value);
    EXPECT_EQ(in_input[i].material, owner.value);
    const double expected = scene.scene.field(SceneField::kLinear, owner, points[i]);
    EXPECT_NEAR(in_mesh[i].values[0], expected, 1e-11);
    EXPECT_NEAR(in_input[i].values[0], expected, 1e-11);
  }
}

/// Returns the distance of a point from a triangle. It tries the face, edges and corners, and so has nothing
/// in common with the tree.
double distance_to_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 a = t[i], along = t[(i + 1) % 3] - a;
    const double length = squared_norm(along);
    const double at = length > 0 ? std::clamp(dot(p - a, along) / length, 0.0, 1.0) : 0;
    least = std::min(least, distance(p, a + at * along));
  }
  const Vec3 normal = normalized(cross(t[1] - t[0], t[2] - t[0]));
  const Vec3 foot = p - dot(p - t[0], normal) * normal;
  for (std::size_t i = 0; i < 3; ++i) {
    if (dot(cross(t[(i + 1) % 3] - t[i], foot - t[i]), normal) < 0) return least;
  }
  return std::min(least, std::abs(dot(p - t[0], normal)));
}

TEST(Probe, DistancesOfAMeshAreThoseOfItsInterfacesFromAnyPlace) {
  for (const char* name : {"sphere", "plate", "voronoi10"}) {
    SceneMeshOptions options;
    options.error = 0.08;
    const SceneMesh scene = make_scene_mesh(name, options);
    const InterfaceMesh shown = approximated_interfaces(scene.mesh).mesh;
    auto points = random_points(100, 6);
    points.insert(points.end(), {{-3, 0.5, 0.5}, {0, 0, 0}, {0.5, 0.5, 40}});
    const auto samples = probe(scene.mesh, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      double expected = std::numeric_limits<double>::infinity();
      for (const InterfaceTriangle& t : shown.triangles) {
        if (t.front == t.back) continue;
        expected = std::min(
            expected, distance_to_triangle(points[i], {shown.points[t.points[0]], shown.points[t.points[1]],
                                                       shown.points[t.points[2]]}));
      }
      EXPECT_NEAR(samples[i].interface_distance, expected, 1e-9) << name << " " << i;
    }
  }
}

TEST(Probe, DistancesAreThoseOfTheSphere) {
  SceneMeshOptions options;
  options.error = 0.01;
  options.most = 30000;
  const SceneMesh scene = make_scene_mesh("sphere", options);
  const SceneSphere& sphere = scene.scene.spheres()[0];
  const auto points = random_points(400, 6);
  const auto in_mesh = probe(scene.mesh, points), in_input = probe(scene.source, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double expected = std::abs(distance(points[i], sphere.center) - sphere.radius);
    EXPECT_NEAR(in_input[i].interface_distance, expected, 0.02);
    EXPECT_NEAR(in_mesh[i].interface_distance, expected, 0.03);
  }
}

TEST(Probe, LinesHaveTheirEnds) {
  const auto points = line_points({0, 0, 0}, {1, 2, 0.1}, 11);
  ASSERT_EQ(points.size(), 11u);
  EXPECT_EQ(points.front(), (Vec3{0, 0, 0}));
  EXPECT_EQ(points.back(), (Vec3{1, 2, 0.1}));
  EXPECT_NEAR(distance(points[3], Vec3{0.3, 0.6, 0.03}), 0, 1e-15);
  EXPECT_THROW(line_points({0, 0, 0}, {1, 1, 1}, 1), Error);
  EXPECT_THROW(line_points({0, 0, 0}, {1, 1, 1}, std::size_t(-1)), Error);
  EXPECT_THROW(line_points({0, std::nan(""), 0}, {1, 1, 1}, 5), Error);
}

TEST(Probe, SameOnAnyNumberOfThreads) {
  const SceneMesh scene = make_scene_mesh("plate");
  const auto points = random_points(2000, 8);
  set_thread_limit(1);
  const auto one = probe(scene.mesh, points);
  set_thread_limit(2);
  const auto two = probe(scene.mesh, points);
  set_thread_limit(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(one[i].body, two[i].body);
    EXPECT_TRUE(std::equal(one[i].values.begin(), one[i].values.end(), two[i].values.begin(), test::same));
  }
}

}  // namespace
}  // namespace adamas
