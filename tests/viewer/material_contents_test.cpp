#include "viewer/contents/material_contents.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "adamas/probe.h"
#include "core/io/array_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/cross_section/cross_section.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/probe/probe.h"
#include "interfaces/selection/saved_hierarchy_file.h"
#include "tests/interfaces/cross_section_meshes.h"
#include "tests/support/scratch.h"
#include "tests/viewer/drawn_triangles.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;
using namespace io;
using namespace isosurface;
using namespace picture;
using namespace viewer;

namespace {

using test::area_of;
using test::Drawn;
using test::in_double;
using test::open_contents;
using test::place;
using test::triangles;

/// Indices of the fields of SceneFields, in the order of the list.
constexpr std::size_t kLinear = 0, kSmooth = 1, kFlow = 2, kFlowY = 4, kFirst = 6;
const std::vector<std::string> kFields{"linear", "smooth", "flow", "flow:0", "flow:1", "flow:2", "first"};

/// A scene with exact fields that is resampled, and both files of it. Ghost values continue linear fields
/// exactly.
struct Sample {
  explicit Sample(const std::string& name)
      : scene(make_scene(name, 3)),
        data(sample_scene(scene, {12, 12, 12})),
        interfaces(scene_interfaces(scene, 1.0 / 24)),
        source(make_mesh_source(interfaces, scene.box(), &data)) {
    source.fields = std::make_shared<test::SceneFields>(scene, data.grid);
    ResamplingOptions options;
    options.interface_error = 0.05;
    options.max_tetrahedra = 2500;
    options.ghost = GhostMode::kLinear;
    options.field_errors.resize(source.fields->fields().size());
    Resampler resampler(source, options);
    resampler.refine();
    mesh = resampled_mesh(resampler);
    vtu = folder / "mesh.vtu";
    h5 = folder / "mesh.h5";
    write_unstructured_mesh(vtu, to_unstructured_mesh(mesh));
    write_array_file(h5, {kHierarchyFormat, kHierarchyVersion, to_arrays(take_hierarchy(resampler))});
  }
  Sample(const Sample&) = delete;

  test::Scratch folder;
  Scene scene;
  MultiMaterialData data;
  InterfaceMesh interfaces;
  ResamplingSource source;
  ResampledMesh mesh;
  std::filesystem::path vtu, h5;
};

class OfScenes : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(MaterialContents, OfScenes, testing::Values("sphere", "tjunction"));

TEST_P(OfScenes, InterfacesHaveTheAreasOfTheMesh) {
  const Sample sample(GetParam());
  const auto contents = open_contents(sample.vtu);
  const InterfaceMesh shown = approximated_interfaces(sample.mesh).mesh;
  std::map<std::pair<std::size_t, std::size_t>, double> areas;
  for (const InterfaceTriangle& t : shown.triangles) {
    const Vec3 &a = shown.points[t.points[0]], &b = shown.points[t.points[1]], &c = shown.points[t.points[2]];
    const auto [front, back] = std::minmax(t.front.value, t.back.value);
    if (front != back) areas[{front, back}] += norm(cross(b - a, c - a)) / 2;
  }
  const auto interfaces = contents->interfaces({});
  ASSERT_EQ(interfaces.size(), areas.size());
  auto expected = areas.begin();
  for (const auto& interface : interfaces) {
    EXPECT_EQ(std::pair(interface.front, interface.back), expected->first);
    EXPECT_NEAR(interface.area, expected->second, 1e-9 * expected->second);
    EXPECT_NEAR(area_of(interface.mesh), expected->second, 1e-5 * expected->second);
    EXPECT_EQ(interface.mesh->origin, sample.mesh.box.center());
    for (const DrawnMesh::Vertex& v : interface.mesh->vertices)
      EXPECT_TRUE(std::isnan(v.front_value) && std::isnan(v.back_value));
    ++expected;
  }
}

TEST_P(OfScenes, NormalsPointToTheFront) {
  const Sample sample(GetParam());
  const auto contents = open_contents(sample.vtu);
  std::size_t looked_at = 0;
  for (const auto& interface : contents->interfaces({})) {
    ASSERT_LT(interface.front, interface.back);
    for (const Drawn& t : triangles(*interface.mesh)) {
      if (t.least_height < 1e-3) continue;
      ++looked_at;
      for (const std::uint32_t v : t.vertices) {
        const Vec3 normal = in_double(interface.mesh->vertices[v].normal);
        EXPECT_NEAR(norm(normal), 1, 1e-6);
        EXPECT_GT(dot(normal, t.normal), 0);
      }
      EXPECT_EQ(contents->at(t.middle + 1e-5 * t.normal, {}).material, interface.front);
      EXPECT_EQ(contents->at(t.middle - 1e-5 * t.normal, {}).material, interface.back);
    }
  }
  EXPECT_GT(looked_at, 10u);
}

TEST_P(OfScenes, SidesHaveTheValuesOfWhatOneSeesFromThere) {
  const Sample sample(GetParam());
  const auto contents = open_contents(sample.vtu);
  ASSERT_EQ(contents->fields(), kFields);
  const auto expect_values = [&](std::size_t field, const auto& expected) {
    for (const auto& interface : contents->interfaces(field)) {
      for (std::uint32_t v = 0; v < interface.mesh->vertices.size(); ++v) {
        const DrawnMesh::Vertex& vertex = interface.mesh->vertices[v];
        const Vec3 p = place(*interface.mesh, v);
        for (const auto& [value, side] :
             {std::pair(vertex.front_value, interface.back), std::pair(vertex.back_value, interface.front)}) {
          const double wanted = expected(MaterialId(side), p);
          ASSERT_EQ(std::isnan(value), std::isnan(wanted)) << kFields[field];
          if (std::isnan(wanted)) continue;
          ASSERT_NEAR(value, wanted, 1e-5 * (1 + std::abs(wanted))) << kFields[field];
        }
      }
    }
  };
  const auto linear = [&](MaterialId m, const Vec3& p) {
    return sample.scene.field(SceneField::kLinear, m, p);
  };
  expect_values(kLinear, linear);
  expect_values(kFlow, [&](MaterialId m, const Vec3& p) { return 3 * std::abs(linear(m, p)); });
  expect_values(kFlowY,
                [&](MaterialId m, const Vec3& p) { return test::SceneFields::factor(1) * linear(m, p); });
  expect_values(
      kFirst, [&](MaterialId m, const Vec3& p) { return m == MaterialId(0) ? linear(m, p) : std::nan(""); });
}

TEST_P(OfScenes, SidesHaveTheValuesThatProbesFindBehindThem) {
  const Sample sample(GetParam());
  const auto contents = open_contents(sample.vtu);
  const CellLocator locator(sample.mesh);
  for (const auto& interface : contents->interfaces(kSmooth)) {
    std::vector<Vec3> points;
    std::vector<double> values;
    for (const Drawn& t : triangles(*interface.mesh)) {
      if (t.least_height < 1e-3) continue;
      double front = 0, back = 0;
      for (const std::uint32_t v : t.vertices) {
        front += interface.mesh->vertices[v].back_value / 3.0;
        back += interface.mesh->vertices[v].front_value / 3.0;
      }
      points.insert(points.end(), {t.middle + 1e-6 * t.normal, t.middle - 1e-6 * t.normal});
      values.insert(values.end(), {front, back});
    }
    ASSERT_FALSE(points.empty());
    const auto samples = probe(sample.mesh, locator, points);
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_NEAR(values[i], samples[i].values[1], 2e-5 * (1 + std::abs(values[i])));
  }
}

TEST_P(OfScenes, RangesAreThoseOfTheMaterialsOwnParts) {
  const Sample sample(GetParam());
  const auto contents = open_contents(sample.vtu);
  for (const auto& [field, component] :
       {std::pair(kLinear, 0), std::pair(kSmooth, 1), std::pair(kFirst, 5)}) {
    double least = INFINITY, greatest = -INFINITY;
    CellOwnership ownership;
    std::vector<OwnedTetrahedron> parts;
    for (std::size_t c = 0; c < sample.mesh.cells.size(); ++c) {
      sample.mesh.ownership(c, ownership);
      partition_cell(ownership, parts);
      for (const OwnedTetrahedron& part : parts) {
        for (const Weights& w : part.corners) {
          const double value =
              sample.mesh.value(c, BodyId(part.owner), static_cast<std::size_t>(component), w);
          if (std::isnan(value)) continue;
          least = std::min(least, value);
          greatest = std::max(greatest, value);
        }
      }
    }
    const auto [low, high] = contents->field_range(field);
    EXPECT_NEAR(low, least, 1e-7 * (1 + std::abs(least))) << kFields[field];
    EXPECT_NEAR(high, greatest, 1e-7 * (1 + std::abs(greatest))) << kFields[field];
  }
}

TEST_P(OfScenes, SectionsHaveTheAreasAndValuesOfTheMaterials) {
  const Sample sample(GetParam());
  const auto contents = open_contents(sample.vtu);
  for (const Plane& plane : test::trying_planes(10)) {
    const CrossSection expected = cross_section(sample.mesh, plane, {});
    const auto section = contents->section(plane, kLinear);
    ASSERT_EQ(section.materials.size(), expected.material_area.size());
    for (MaterialId m(0); m.value < section.materials.size(); ++m.value) {
      const SharedMesh& mesh = section.materials[m.value];
      EXPECT_NEAR(area_of(mesh), expected.material_area[m], 1e-5);
      ASSERT_EQ(mesh == nullptr, expected.material_area[m] == 0);
      if (mesh == nullptr) continue;
      for (const Drawn& t : triangles(*mesh)) {
        if (t.least_height < 1e-3) continue;
        EXPECT_GT(dot(t.normal, plane.normal), 0);
      }
      for (std::uint32_t v = 0; v < mesh->vertices.size(); ++v) {
        const DrawnMesh::Vertex& vertex = mesh->vertices[v];
        const double value = sample.scene.field(SceneField::kLinear, m, place(*mesh, v));
        EXPECT_NEAR(vertex.front_value, value, 1e-5 * (1 + std::abs(value)));
        EXPECT_EQ(vertex.front_value, vertex.back_value);
        EXPECT_NEAR(dot(in_double(vertex.normal), normalized(plane.normal)), 1, 1e-6);
      }
    }
    ASSERT_TRUE(section.cell_edges && section.cell_edges->is_lines);
    EXPECT_EQ(section.cell_edges->indices.size(), 2 * expected.cell_edges.size());
    EXPECT_EQ(section.interface_edges ? section.interface_edges->indices.size() : 0,
              2 * expected.interface_edges.size());
  }
}

TEST_P(OfScenes, PlanesThatPassByCutNothing) {
  const Sample sample(GetParam());
  const auto contents = open_contents(sample.vtu);
  const Vec3 up{0, 0, 1};
  for (const Plane& plane : {Plane{{0, 0, 1.5}, up}, Plane{{0, 0, -0.1}, up}, Plane{{1, 1, 1}, {1, 1, 1}},
                             Plane{{0.5, 0.5, 0.5}, {}}, Plane{{0, 0, std::nan("")}, up}}) {
    const auto section = contents->section(plane, {});
    ASSERT_EQ(section.materials.size(), contents->materials().size());
    for (const SharedMesh& mesh : section.materials) EXPECT_EQ(mesh, nullptr);
    EXPECT_TRUE(section.cell_edges == nullptr && section.interface_edges == nullptr);
  }
}

TEST_P(OfScenes, ReadingsAreThoseOfTheCells) {
  const Sample sample(GetParam());
  const auto contents = open_contents(sample.vtu);
  for (const Vec3& p : line_points({0.03, 0.11, 0.07}, {0.97, 0.71, 0.93}, 200)) {
    const auto found = test::find_cell(sample.mesh, p);
    const BodyId owner = test::owner_in(sample.mesh, found);
    const auto reading = contents->at(p, kSmooth);
    ASSERT_EQ(reading.material, sample.mesh.table.material(owner).value);
    EXPECT_NEAR(reading.value, sample.mesh.value(found.cell, owner, 1, found.weights), 1e-9);
    EXPECT_EQ(reading.interface_error, sample.mesh.cells[found.cell].interface_error);
    EXPECT_TRUE(test::same(reading.field_error, sample.mesh.field_errors[1][found.cell]));
    EXPECT_TRUE(std::isnan(contents->at(p, {}).value));
  }
  for (const Vec3& p : {Vec3{-1e-9, 0.5, 0.5}, Vec3{7, 7, 7}, Vec3{0.5, std::nan(""), 0.5}}) {
    const auto reading = contents->at(p, kLinear);
    EXPECT_FALSE(reading.material);
    EXPECT_TRUE(std::isnan(reading.value) && std::isnan(reading.interface_error) &&
                std::isnan(reading.field_error));
  }
}

TEST_P(OfScenes, HierarchiesGiveTheSameScene) {
  const Sample sample(GetParam());
  EXPECT_TRUE(MaterialContents::can_open(sample.vtu.string()));
  EXPECT_TRUE(MaterialContents::can_open(sample.h5.string()));
  const auto a = open_contents(sample.vtu), b = open_contents(sample.h5);
  EXPECT_EQ(a->summary(), b->summary());
  EXPECT_EQ(a->materials(), b->materials());
  EXPECT_EQ(a->fields(), b->fields());
  EXPECT_EQ(a->box().min, b->box().min);
  EXPECT_EQ(a->box().max, b->box().max);
  for (std::size_t f = 0; f < kFields.size(); ++f) {
    EXPECT_NEAR(a->field_range(f).first, b->field_range(f).first, 1e-12) << kFields[f];
    EXPECT_NEAR(a->field_range(f).second, b->field_range(f).second, 1e-12) << kFields[f];
  }
  const auto of_a = a->interfaces(kSmooth), of_b = b->interfaces(kSmooth);
  ASSERT_EQ(of_a.size(), of_b.size());
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    EXPECT_EQ(std::pair(of_a[i].front, of_a[i].back), std::pair(of_b[i].front, of_b[i].back));
    EXPECT_NEAR(of_a[i].area, of_b[i].area, 1e-12);
    EXPECT_EQ(of_a[i].mesh->indices.size(), of_b[i].mesh->indices.size());
    EXPECT_EQ(of_a[i].mesh->vertices.size(), of_b[i].mesh->vertices.size());
  }
  for (const Vec3& p : line_points({0.03, 0.11, 0.07}, {0.97, 0.71, 0.93}, 50)) {
    EXPECT_EQ(a->at(p, kSmooth).material, b->at(p, kSmooth).material);
    EXPECT_NEAR(a->at(p, kSmooth).value, b->at(p, kSmooth).value, 1e-12);
  }
}

TEST_P(OfScenes, SummariesCount) {
  const Sample sample(GetParam());
  std::string summary = open_contents(sample.vtu)->summary();
  std::erase(summary, ',');
  EXPECT_EQ(summary, fmt::format("{} tetrahedra {} points {} materials", sample.mesh.cells.size(),
                                 sample.mesh.points.size(), sample.mesh.materials.size()));
}

}  // namespace
}  // namespace adamas
