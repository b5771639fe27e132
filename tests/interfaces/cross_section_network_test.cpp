#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "interfaces/cross_section/cross_section.h"
#include "tests/interfaces/cross_section_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

const Box3 kUnit{{0, 0, 0}, {1, 1, 1}};

TEST(CrossSectionNetwork, PiecesFillThePlaneAndBelongToTheirOwner) {
  for (const char* name : {"sphere", "shell3", "tjunction", "reflex", "voronoi10"}) {
    const Scene scene = make_scene(name);
    const InterfaceNetwork network(scene_interfaces(scene, 0.05), scene.box());
    auto planes = test::trying_planes(12);
    for (const char* text : {"x=0.5", "y=0.25", "z=0.7", "z=0", "x=1"}) planes.push_back(parse_plane(text));
    for (const Plane& plane : planes) {
      const auto outline = clip_plane(plane, scene.box());
      if (outline.empty()) continue;
      const CrossSection section =
          cross_section(network, scene.box(), scene.materials().size(), plane, scene.name());
      const double whole = polygon_area(outline);
      EXPECT_NEAR(section.area, whole, 1e-9) << name << " " << to_string(plane);
      double sum = 0;
      for (const double area : section.material_area) sum += area;
      EXPECT_NEAR(sum, section.area, 1e-9);
      const Vec3 normal = normalized(plane.normal);
      for (const SectionPiece& piece : section.pieces) {
        const Vec3 turn = cross(piece.corners[1] - piece.corners[0], piece.corners[2] - piece.corners[0]);
        EXPECT_GE(dot(turn, normal), -1e-12);
        Vec3 middle;
        for (const Vec3& p : piece.corners) {
          EXPECT_NEAR(dot(p - plane.origin, normal), 0, 1e-9);
          middle += 1.0 / static_cast<double>(piece.corners.size()) * p;
        }
        if (norm(turn) < 1e-6) continue;
        // The material is the true one, except near curved interfaces, which the triangles approximate, and
        // in planes that contain interfaces.
        const bool far = !scene.planar() && std::abs(distance(middle, Vec3{0.5, 0.5, 0.5}) - 0.35) < 0.2;
        const auto closest = network.tree().closest(middle);
        if (far || (closest && closest->squared_distance < 1e-16)) continue;
        EXPECT_EQ(piece.material, scene.owner(middle)) << name << " " << to_string(plane);
      }
    }
  }
}

TEST(CrossSectionNetwork, AreasOfASphere) {
  const Scene scene = make_scene("sphere");
  const SceneSphere& sphere = scene.spheres()[0];
  const InterfaceNetwork network(scene_interfaces(scene, 0.01), scene.box());
  for (const double off : {0.0, 0.1, 0.2, 0.3}) {
    Plane plane = parse_plane("y=0.5");
    plane.origin.y = sphere.center.y + off;
    const CrossSection section = cross_section(network, kUnit, 2, plane, "sphere");
    const double area = std::numbers::pi * (sphere.radius * sphere.radius - off * off);
    EXPECT_NEAR(section.material_area[sphere.inside], area, 2e-3 * area);
  }
}

TEST(CrossSectionNetwork, InterfacesMayLeaveTheBoxAndCross) {
  const Scene scene = make_scene("sphere");
  InterfaceMesh mesh = scene_interfaces(scene, 0.05);
  const Box3 small{{0.5, 0.5, 0.5}, {2, 2, 2}};
  const InterfaceNetwork network(mesh, small);
  const CrossSection section = cross_section(network, small, 2, parse_plane("z=0.5"), "sphere");
  EXPECT_NEAR(section.area, 2.25, 1e-9);
  const SceneSphere& sphere = scene.spheres()[0];
  const double quarter = 0.25 * std::numbers::pi * sphere.radius * sphere.radius;
  EXPECT_NEAR(section.material_area[sphere.inside], quarter, 0.02 * quarter);
}

/// Where interfaces end in the box, bodies beyond their ends are those that the network finds point by point.
TEST(CrossSectionNetwork, InterfacesThatEndInTheBoxGoOnStraight) {
  const Box3 larger{{-0.06, -0.05, -0.04}, {1.03, 1.05, 1.08}};
  for (const char* name : {"tjunction", "reflex", "voronoi10"}) {
    const Scene scene = make_scene(name);
    const InterfaceNetwork network(scene_interfaces(scene, 0.05), larger);
    const std::size_t materials = scene.materials().size();
    for (const char* text : {"x=0.52", "y=0.25", "z=0.73"}) {
      const Plane plane = parse_plane(text);
      const PlaneFrame frame = plane_frame(plane);
      const CrossSection section = cross_section(network, larger, materials, plane, name);
      IdVector<MaterialId, double> sampled;
      sampled.assign(materials, 0);
      const double right = dot(frame.right, larger.size()), up = dot(frame.up, larger.size());
      constexpr int kSamples = 300;
      for (int i = 0; i < kSamples; ++i) {
        for (int j = 0; j < kSamples; ++j) {
          Vec3 p = larger.min + ((i + 0.5) / kSamples * right) * frame.right +
                   ((j + 0.5) / kSamples * up) * frame.up;
          p[*plane.axis()] = plane.origin[*plane.axis()];
          sampled[network.table().material(network.body_at(p))] += right * up / (kSamples * kSamples);
        }
      }
      for (MaterialId m(0); m.value < materials; ++m.value)
        EXPECT_NEAR(section.material_area[m], sampled[m], 2e-3) << name << " " << text << " " << m.value;
    }
  }
}

}  // namespace
}  // namespace adamas
