#include "datasets/scene_interfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace adamas {

using namespace datasets;

namespace {

Vec3 point(const InterfaceMesh& mesh, const InterfaceTriangle& t, std::size_t corner) {
  return mesh.points[t.points[corner]];
}

/// Returns whether both points lie on one side of the box.
bool on_side(const Box3& box, const Vec3& a, const Vec3& b) {
  const double tolerance = 1e-12 * box.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {box.min[axis], box.max[axis]}) {
      if (std::abs(a[axis] - side) <= tolerance && std::abs(b[axis] - side) <= tolerance) return true;
    }
  }
  return false;
}

/// Expects that the boundary of each material runs along each edge inside the box as often in one direction
/// as in the other.
void expect_closed(const Scene& scene, const InterfaceMesh& mesh) {
  std::map<std::array<std::uint32_t, 3>, int> balance;  // material, low point, high point
  for (const InterfaceTriangle& t : mesh.triangles) {
    ASSERT_NE(t.front, t.back);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = t.points[c], b = t.points[(c + 1) % 3];
      ASSERT_NE(a, b);
      const int direction = a < b ? 1 : -1;
      balance[{t.front.value, std::min(a, b), std::max(a, b)}] += direction;
      balance[{t.back.value, std::min(a, b), std::max(a, b)}] -= direction;
    }
  }
  std::size_t open = 0;
  for (const auto& [edge, sum] : balance) {
    if (sum != 0 && !on_side(scene.box(), mesh.points[edge[1]], mesh.points[edge[2]])) ++open;
  }
  EXPECT_EQ(open, 0u) << scene.name();
}

/// Returns the volume of a material that does not touch the box, by the divergence theorem.
double enclosed_volume(const InterfaceMesh& mesh, MaterialId m, const Vec3& origin) {
  double volume = 0;
  for (const InterfaceTriangle& t : mesh.triangles) {
    const double part = signed_volume(origin, point(mesh, t, 0), point(mesh, t, 1), point(mesh, t, 2));
    if (t.back == m) volume += part;
    if (t.front == m) volume -= part;
  }
  return volume;
}

/// Expects that at points on the triangles the functions of both materials are the greatest ones, within
/// `tolerance`.
void expect_on_interfaces(const Scene& scene, const InterfaceMesh& mesh, double tolerance) {
  for (const InterfaceTriangle& t : mesh.triangles) {
    const Vec3 middle = (1.0 / 3) * (point(mesh, t, 0) + point(mesh, t, 1) + point(mesh, t, 2));
    for (const Vec3& p : {point(mesh, t, 0), point(mesh, t, 1), point(mesh, t, 2), middle}) {
      const double greatest = scene.value(scene.owner(p), p);
      ASSERT_GE(scene.value(t.front, p), greatest - tolerance) << scene.name();
      ASSERT_GE(scene.value(t.back, p), greatest - tolerance) << scene.name();
    }
  }
}

/// Expects that normals point to the front: a step along them leads to it.
void expect_sides(const Scene& scene, const InterfaceMesh& mesh, double step) {
  std::size_t wrong = 0, tried = 0;
  for (const InterfaceTriangle& t : mesh.triangles) {
    const Vec3 a = point(mesh, t, 0), b = point(mesh, t, 1), c = point(mesh, t, 2);
    const Vec3 normal = cross(b - a, c - a);
    if (norm(normal) < step * step) continue;
    const Vec3 middle = (1.0 / 3) * (a + b + c), offset = step * normalized(normal);
    ++tried;
    wrong += scene.owner(middle + offset) == t.front && scene.owner(middle - offset) == t.back ? 0 : 1;
  }
  EXPECT_GT(tried, 0u);
  EXPECT_EQ(wrong, 0u) << scene.name();
}

/// Returns the pairs of materials that share an interface.
std::set<std::pair<std::uint32_t, std::uint32_t>> pairs(const InterfaceMesh& mesh) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> result;
  for (const InterfaceTriangle& t : mesh.triangles) result.insert(std::minmax(t.front.value, t.back.value));
  return result;
}

TEST(SceneInterfaces, PlanarScenesAreExact) {
  for (const std::string name : {"plate", "tjunction", "reflex", "voronoi10"}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      const Scene scene = make_scene(name, seed);
      const InterfaceMesh mesh = scene_interfaces(scene, 0.1);
      ASSERT_FALSE(mesh.triangles.empty());
      expect_closed(scene, mesh);
      expect_on_interfaces(scene, mesh, 1e-12);
      expect_sides(scene, mesh, 1e-6);
    }
  }
}

TEST(SceneInterfaces, ThePlateEnclosesItsVolume) {
  const Scene scene = make_scene("plate");
  const InterfaceMesh mesh = scene_interfaces(scene, 0.1);
  EXPECT_NEAR(enclosed_volume(mesh, MaterialId(1), {}), scene.volume(MaterialId(1)), 1e-12);
}

TEST(SceneInterfaces, AreasOfTheTJunction) {
  // The first plane is the diagonal rectangle of the cube.
  const Scene scene = make_scene("tjunction");
  const InterfaceMesh mesh = scene_interfaces(scene, 1);
  double area = 0;
  for (const InterfaceTriangle& t : mesh.triangles) {
    const Vec3 a = point(mesh, t, 0);
    if (t.front.value != 0 && t.back.value != 0) continue;
    area += 0.5 * norm(cross(point(mesh, t, 1) - a, point(mesh, t, 2) - a));
  }
  EXPECT_NEAR(area, std::sqrt(2.0), 1e-12);
  EXPECT_EQ(pairs(mesh).size(), 3u);
}

TEST(SceneInterfaces, SpheresAreClosedAndTrue) {
  for (const std::string name : {"sphere", "shell2", "shell3"}) {
    const Scene scene = make_scene(name);
    const double h = 1.0 / 24;
    const InterfaceMesh mesh = scene_interfaces(scene, h);
    expect_closed(scene, mesh);
    std::vector<std::size_t> on(scene.spheres().size());
    for (const Vec3& p : mesh.points) {
      std::size_t touched = 0;
      for (std::size_t s = 0; s < on.size(); ++s) {
        if (std::abs(distance(p, scene.spheres()[s].center) - scene.spheres()[s].radius) > 1e-12) continue;
        ++touched;
        ++on[s];
      }
      EXPECT_EQ(touched, 1u) << name;
    }
    for (const std::size_t count : on) EXPECT_GT(count, 500u) << name;
    for (MaterialId m(1); m.value < scene.materials().size(); ++m.value) {
      // A chord of length c leaves c^2 / 8 r below the sphere.
      const double tolerance = 3 * h * h / (8 * 0.3) * 4 * std::acos(-1.0) * 0.31 * 0.31;
      EXPECT_NEAR(enclosed_volume(mesh, m, scene.box().center()), scene.volume(m), tolerance) << name;
    }
  }
}

TEST(SceneInterfaces, SphereVolumesConvergeInSecondOrder) {
  const Scene scene = make_scene("sphere");
  const auto error = [&](double h) {
    return std::abs(enclosed_volume(scene_interfaces(scene, h), MaterialId(1), {}) -
                    scene.volume(MaterialId(1)));
  };
  const double ratio = error(1.0 / 16) / error(1.0 / 32);
  EXPECT_GT(ratio, 3.3);
  EXPECT_LT(ratio, 4.7);
}

TEST(SceneInterfaces, RandomScenesAreClosedAndClose) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Scene scene = make_scene("random", seed);
    const double h = 1.0 / 16;
    const InterfaceMesh mesh = scene_interfaces(scene, h);
    SCOPED_TRACE(seed);
    expect_closed(scene, mesh);
    // Radii are 0.15 and more: linear interpolation is off by at most 3 h^2 / (8 r), twice for a difference.
    expect_on_interfaces(scene, mesh, scene.planar() ? 1e-12 : 4 * 3 * h * h / (8 * 0.15));
  }
}

TEST(LongSceneInterfaces, ManyRandomScenesAreClosed) {
  for (std::uint64_t seed = 100; seed < 300; ++seed) {
    const Scene scene = make_scene("random", seed);
    SCOPED_TRACE(seed);
    expect_closed(scene, scene_interfaces(scene, 1.0 / 12));
  }
}

TEST(SceneInterfaces, TheSameOnAnyNumberOfThreads) {
  const Scene scene = make_scene("random", 5);
  set_thread_limit(1);
  const InterfaceMesh one = scene_interfaces(scene, 0.07);
  set_thread_limit(2);
  const InterfaceMesh two = scene_interfaces(scene, 0.07);
  set_thread_limit(0);
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.triangles, two.triangles);
}

TEST(SceneInterfaces, BadResolutionsAreRefused) {
  const Scene scene = make_scene("sphere");
  for (const double resolution : {0.0, -1.0, 1e-9, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(scene_interfaces(scene, resolution), Error) << resolution;
  }
}

}  // namespace
}  // namespace adamas
