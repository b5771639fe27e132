#include "interfaces/network/network_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/network/interface_network.h"
#include "tests/interfaces/network_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

double sum(const IdVector<MaterialId, double>& volumes) {
  return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

/// Returns the volumes of materials by asking for the owner of the middles of n^3 cells.
IdVector<MaterialId, double> sampled_volumes(const InterfaceNetwork& network, const Box3& box,
                                             std::size_t materials, std::size_t n) {
  IdVector<MaterialId, double> volumes(materials, 0.0);
  const double part = box.volume() / std::pow(static_cast<double>(n), 3);
  for (std::size_t i = 0; i < n * n * n; ++i) {
    const Vec3 at{static_cast<double>(i % n) + 0.5, static_cast<double>(i / n % n) + 0.5,
                  static_cast<double>(i / (n * n)) + 0.5};
    const Vec3 size = box.size(), step = (1.0 / static_cast<double>(n)) * at;
    const Vec3 p = box.min + Vec3{step.x * size.x, step.y * size.y, step.z * size.z};
    volumes[network.table().material(network.body_at(p))] += part;
  }
  return volumes;
}

TEST(NetworkMeasures, PlanesThroughTheBoxAreExact) {
  // The normals have all signs, and some are along axes, so that every face, edge and corner of the box is
  // cut somewhere.
  for (const Vec3 normal : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{1, 1, 1}, Vec3{-1, 0.3, 0.2},
                            Vec3{0.2, -1, 0.7}, Vec3{-0.4, -0.3, -1}, Vec3{1, 1, 0}, Vec3{0, 1, -1}}) {
    for (const Vec3 through : {Vec3{1, 2.5, 3.4}, Vec3{0.3, 2.1, 3.9}, Vec3{1.7, 2.9, 3.1}}) {
      const Box3 box{{0, 2, 3}, {2, 3, 4}};
      const Vec3 n = normalized(normal);
      const Vec3 u = normalized(std::abs(n.x) < 0.8 ? cross(n, Vec3{1, 0, 0}) : cross(n, Vec3{0, 1, 0}));
      const Vec3 v = cross(n, u);
      InterfaceMesh mesh = test::mesh_with_materials(2);
      // The patch is much larger than the box, which cuts it.
      test::add_patch(mesh, through - 5 * u - 5 * v, 10 * u, 10 * v, MaterialId(0), MaterialId(1), 7);
      const InterfaceNetwork network(mesh, box);
      const auto found = measure_network(network, box, 2);
      // The volume is measured independently as a sum over thin columns along z. The sum is exact for a plane
      // except in columns whose ends the plane cuts.
      double front = 0;
      constexpr int kColumns = 400;
      for (int i = 0; i < kColumns * kColumns; ++i) {
        const double x = 2 * (i % kColumns + 0.5) / kColumns, y = 2 + 1 * (i / kColumns + 0.5) / kColumns;
        const double at_lower = dot(Vec3{x, y, 3} - through, n), at_upper = dot(Vec3{x, y, 4} - through, n);
        const double part = at_lower > 0 && at_upper > 0 ? 1
                            : at_lower <= 0 && at_upper <= 0
                                ? 0
                                : std::max(at_lower, at_upper) / std::abs(at_upper - at_lower);
        front += part * 2.0 / (kColumns * kColumns);
      }
      EXPECT_NEAR(found.volumes[MaterialId(0)], front, 5e-3);
      EXPECT_NEAR(sum(found.volumes), 2, 1e-12);
    }
  }
}

TEST(NetworkMeasures, JunctionsAndClosedBodiesHaveTheirVolumes) {
  for (const char* name : {"tjunction", "reflex", "voronoi10", "plate", "shell3"}) {
    const Scene scene = make_scene(name);
    const InterfaceMesh mesh = scene_interfaces(scene, 0.02);
    const InterfaceNetwork network(mesh, scene.box());
    const auto found = measure_network(network, scene.box(), scene.materials().size());
    EXPECT_NEAR(sum(found.volumes), scene.box().volume(), 1e-10);
    for (MaterialId m(0); m.value < scene.materials().size(); ++m.value)
      EXPECT_NEAR(found.volumes[m], scene.volume(m), scene.planar() ? 1e-9 + scene.volume_error(m) : 2e-3)
          << name << " " << m.value;
  }
}

TEST(NetworkMeasures, TrianglesThatLeaveTheBoxCountInsideAlone) {
  InterfaceMesh mesh = test::mesh_with_materials(3);
  test::add_sphere(mesh, {0.9, 0.95, 0.9}, 0.3, MaterialId(0), MaterialId(1), 20);
  test::add_sphere(mesh, {0.2, 0.5, 0.5}, 0.1, MaterialId(0), MaterialId(2), 20);
  const Box3 box = test::unit_box();
  const InterfaceNetwork network(mesh, box);
  const auto found = measure_network(network, box, 3);
  const auto expected = sampled_volumes(network, box, 3, 60);
  for (MaterialId m(0); m.value < 3; ++m.value) EXPECT_NEAR(found.volumes[m], expected[m], 1.5e-3);
  const double sphere = 4 * M_PI * 0.01;
  double whole = 0;
  for (InterfaceId i(0); i.value < found.areas.size(); ++i.value) {
    if (network.table().material(network.interface(i).a) == MaterialId(2) ||
        network.table().material(network.interface(i).b) == MaterialId(2))
      whole += found.areas[i];
  }
  EXPECT_NEAR(whole, sphere, 0.01 * sphere);
}

}  // namespace
}  // namespace adamas
