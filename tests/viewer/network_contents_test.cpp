#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <random>

#include "core/geometry/plane.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "core/picture/material_colours.h"
#include "datasets/scene.h"
#include "datasets/scene_interfaces.h"
#include "tests/support/scratch.h"
#include "tests/viewer/drawn_triangles.h"
#include "viewer/contents/document.h"

namespace adamas {

using namespace datasets;
using namespace io;
using namespace viewer;

namespace {

using test::area_of;
using test::Drawn;
using test::in_double;
using test::open_contents;
using test::place;
using test::triangles;

/// Returns a ball of radius 1 of the second material.
InterfaceMesh ball(int rings) {
  InterfaceMesh mesh;
  mesh.materials = {"outside", "inside"};
  const int around = 2 * rings;
  const auto add = [&](int r, int a) {
    const double t = std::numbers::pi * r / rings, f = 2 * std::numbers::pi * a / around;
    mesh.points.push_back({std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t)});
  };
  add(0, 0);
  for (int r = 1; r < rings; ++r) {
    for (int a = 0; a < around; ++a) add(r, a);
  }
  add(rings, 0);
  const auto last = static_cast<std::uint32_t>(mesh.points.size() - 1);
  const auto at = [&](int r, int a) {
    if (r == 0) return 0u;
    return r == rings ? last : static_cast<std::uint32_t>(1 + (r - 1) * around + a % around);
  };
  for (int r = 0; r < rings; ++r) {
    for (int a = 0; a < around; ++a) {
      if (r + 1 < rings)
        mesh.triangles.push_back({{at(r, a), at(r + 1, a), at(r + 1, a + 1)}, MaterialId(0), MaterialId(1)});
      if (r > 0)
        mesh.triangles.push_back({{at(r, a), at(r + 1, a + 1), at(r, a + 1)}, MaterialId(0), MaterialId(1)});
    }
  }
  return mesh;
}

/// Returns the unit cube; the two materials take turns as the one in front.
InterfaceMesh cube() {
  InterfaceMesh mesh;
  mesh.materials = {"outside", "inside"};
  for (const Vec3& p : Box3{{0, 0, 0}, {1, 1, 1}}.corners()) mesh.points.push_back(p);
  for (const auto& [a, b, c, d] : std::initializer_list<std::array<std::uint32_t, 4>>{
           {0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}) {
    mesh.triangles.push_back({{a, b, c}, MaterialId(0), MaterialId(1)});
    mesh.triangles.push_back({{a, d, c}, MaterialId(1), MaterialId(0)});
  }
  return mesh;
}

TEST(NetworkContents, MaterialsHaveTheColoursOfTheFile) {
  const test::Scratch scratch;
  const std::string file = (scratch / "ball.vtp").string();
  write_interface_mesh(file, ball(6), {{"inside", {0.25, 0.5, 0.75}}});
  const auto document = open_document(file, {}, SilentProgress::instance());
  const DocumentFacts& facts = document->facts();
  ASSERT_EQ(facts.materials, (std::vector<std::string>{"outside", "inside"}));
  EXPECT_EQ(facts.material_colours[0], picture::material_colour(0));
  EXPECT_EQ(facts.material_colours[1], (picture::Colour{0.25, 0.5, 0.75}));
}

TEST(NetworkContents, SmoothSurfacesHaveOneNormalAtAPoint) {
  const test::Scratch folder;
  const InterfaceMesh mesh = ball(24);
  write_interface_mesh(folder / "ball.ply", mesh);
  const auto interfaces = open_contents(folder / "ball.ply")->interfaces({});
  ASSERT_EQ(interfaces.size(), 1u);
  const DrawnMesh& drawn = *interfaces[0].mesh;
  EXPECT_EQ(drawn.vertices.size(), mesh.points.size());
  EXPECT_EQ(drawn.indices.size(), 3 * mesh.triangles.size());
  for (std::uint32_t v = 0; v < drawn.vertices.size(); ++v)
    EXPECT_GT(dot(in_double(drawn.vertices[v].normal), place(drawn, v)), 0.999);
}

TEST(NetworkContents, CreasesStaySharp) {
  const test::Scratch folder;
  write_interface_mesh(folder / "cube.ply", cube());
  const auto interfaces = open_contents(folder / "cube.ply")->interfaces({});
  ASSERT_EQ(interfaces.size(), 1u);
  const DrawnMesh& drawn = *interfaces[0].mesh;
  EXPECT_EQ(drawn.vertices.size(), 24u);  // each of the 8 corners is there once for each of its three sides
  EXPECT_NEAR(interfaces[0].area, 6, 1e-12);
  for (const Drawn& t : triangles(drawn)) {
    EXPECT_GT(dot(t.normal, t.middle - Vec3{0.5, 0.5, 0.5}), 0.1);
    for (const std::uint32_t v : t.vertices)
      EXPECT_NEAR(dot(in_double(drawn.vertices[v].normal), t.normal), 1, 1e-6);
  }
}

TEST(NetworkContents, ClosedInterfacesHaveSpaceRoundThem) {
  const test::Scratch folder;
  write_interface_mesh(folder / "ball.vtp", ball(12));
  const auto contents = open_contents(folder / "ball.vtp");
  const Box3 box = contents->box();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LT(box.min[axis], -1.05);
    EXPECT_GT(box.max[axis], 1.05);
  }
  EXPECT_EQ(contents->summary(), "528 triangles, 266 points, 2 materials");
  EXPECT_EQ(contents->at({0, 0, 0}, {}).material, 1u);
  EXPECT_EQ(contents->at({1.04, 0, 0}, {}).material, 0u);
  EXPECT_FALSE(contents->at({3, 0, 0}, {}).material);
  EXPECT_TRUE(contents->fields().empty());
  write_interface_mesh(folder / "fine.ply", ball(24));
  EXPECT_EQ(open_contents(folder / "fine.ply")->summary(), "2,208 triangles, 1,106 points, 2 materials");
}

/// Interfaces that the unit cube cuts end on its sides.
TEST(NetworkContents, CutOffInterfacesEndOnTheBox) {
  const test::Scratch folder;
  const Scene exact = make_scene("tjunction");
  for (const char* name : {"t.ply", "t.vtp"}) {
    write_interface_mesh(folder / name, scene_interfaces(exact, 0.1));
    const auto contents = open_contents(folder / name);
    ASSERT_EQ(contents->materials(), exact.materials());
    const Box3 box = contents->box();
    EXPECT_LT(distance(box.min, exact.box().min) + distance(box.max, exact.box().max), 1e-9);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(0.001, 0.999);
    for (int i = 0; i < 300; ++i) {
      const Vec3 p{unit(random), unit(random), unit(random)};
      EXPECT_EQ(contents->at(p, {}).material, exact.owner(p).value);
    }
    for (const Plane& plane :
         {Plane{{0.5, 0.45, 0.5}, {0.1, 1, 0.2}}, Plane{{0.4, 0.5, 0.5}, {1, -0.3, 0.7}}}) {
      const auto section = contents->section(plane, {});
      double area = 0;
      for (std::size_t m = 0; m < section.materials.size(); ++m) {
        area += area_of(section.materials[m]);
        if (section.materials[m] == nullptr) continue;
        for (const Drawn& t : triangles(*section.materials[m])) {
          if (t.least_height < 1e-3) continue;
          EXPECT_EQ(contents->at(t.middle, {}).material, m);
        }
      }
      EXPECT_NEAR(area, polygon_area(clip_plane(plane, box)), 1e-5);
      EXPECT_EQ(section.cell_edges, nullptr);
      ASSERT_NE(section.interface_edges, nullptr);
      EXPECT_TRUE(section.interface_edges->is_lines);
    }
  }
}

TEST(NetworkContents, KnowsItsFiles) {
  const test::Scratch folder;
  const InterfaceMesh mesh = ball(8);
  for (const char* name : {"ball.arec", "ball.txt", "ball.ply", "ball.vtp"}) {
    write_interface_mesh(folder / name, mesh);
    EXPECT_TRUE(MaterialContents::can_open((folder / name).string())) << name;
    EXPECT_NEAR(open_contents(folder / name)->interfaces({})[0].area, 4 * std::numbers::pi, 0.8) << name;
  }
}

TEST(NetworkContents, OtherFilesAreRefused) {
  const test::Scratch folder;
  const auto refusal = [&](const std::string& name) {
    const std::string path = (folder / name).string();
    const std::string message = test::error_of([&] { open_contents(path); });
    EXPECT_TRUE(test::says(message, path));
    return message;
  };
  const char* other = "expected a resampled mesh";
  test::put_bytes(folder / "volume.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1 1 1\n\nx");
  test::put_bytes(folder / "other.h5", "\x89HDF\r\n\x1a\n");
  write_interface_mesh(folder / "ball.stl", ball(8));
  for (const char* name : {"volume.nrrd", "other.h5", "ball.stl"}) {
    EXPECT_FALSE(MaterialContents::can_open((folder / name).string())) << name;
    EXPECT_TRUE(test::says(refusal(name), other));
  }
  test::put_bytes(folder / "notes.txt", "These are notes.\n");
  refusal("notes.txt");
  test::put_bytes(folder / "empty.vtu", "");
  EXPECT_TRUE(test::says(refusal("empty.vtu"), "an empty file"));
  EXPECT_TRUE(test::says(refusal("missing.vtu"), "found none"));
  UnstructuredMesh plain;
  plain.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  plain.connectivity = {0, 1, 2, 3};
  plain.offsets = {0, 4};
  write_unstructured_mesh(folder / "plain.vtu", plain);
  EXPECT_TRUE(test::says(refusal("plain.vtu"), "written by adamas resample"));
  InterfaceMesh flat = ball(8);
  for (Vec3& p : flat.points) p = {p.x, 0, 0};
  write_interface_mesh(folder / "flat.vtp", flat);
  refusal("flat.vtp");
}

}  // namespace
}  // namespace adamas
