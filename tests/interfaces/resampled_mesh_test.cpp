#include "interfaces/mesh/resampled_mesh.h"

#include <cmath>
#include <map>

#include "core/base/error.h"
#include "interfaces/fields/grid_field_source.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/hierarchy_validation.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

ResampledMesh resampled(const std::string& scene) {
  test::SceneCase c;
  c.name = scene;
  c.fields = true;
  c.options.interface_error = 0.06;
  test::ResampledScene result(c);
  return resampled_mesh(*result.resampler);
}

template <class Values>
Values& array(UnstructuredMesh& mesh, const std::string& name) {
  for (NamedArray& a : mesh.field_arrays) {
    if (a.name == "adamas " + name) return std::get<Values>(a.values);
  }
  throw std::logic_error("no array " + name);
}

TEST(ResampledMesh, ComesBackFromAFile) {
  const ResampledMesh mesh = resampled("tjunction");
  ASSERT_NO_THROW(mesh.validate("mesh"));
  const ResampledMesh back = from_unstructured_mesh(to_unstructured_mesh(mesh), "file");
  EXPECT_EQ(back.source, mesh.source);
  EXPECT_EQ(back.points.size(), mesh.points.size());
  EXPECT_EQ(back.field_errors, mesh.field_errors);
  ASSERT_EQ(back.cells.size(), mesh.cells.size());
  CellOwnership a, b;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    EXPECT_EQ(back.cells[c].interface_error, mesh.cells[c].interface_error);
    mesh.ownership(c, a);
    back.ownership(c, b);
    ASSERT_EQ(a.problem.candidates.size(), b.problem.candidates.size());
    const Weights w{0.1, 0.2, 0.3, 0.4};
    if (!a.pure()) {
      ASSERT_EQ(a.problem.owner(w), b.problem.owner(w));
    }
    const BodyId body(a.pure() ? a.problem.candidates[0].owner : a.problem.owner(w));
    for (const FieldInfo& field : mesh.fields) {
      const double value = mesh.value(c, body, field.offset, w), other = back.value(c, body, field.offset, w);
      ASSERT_TRUE(value == other || (std::isnan(value) && std::isnan(other)));
    }
  }
}

TEST(ResampledMesh, DamagedFilesAreRefused) {
  using Integers = std::vector<std::int32_t>;
  using Doubles = std::vector<double>;
  const UnstructuredMesh good = to_unstructured_mesh(resampled("tjunction"));
  const auto refused = [&](const std::function<void(UnstructuredMesh&)>& damage) {
    UnstructuredMesh bad = good;
    damage(bad);
    try {
      from_unstructured_mesh(bad, "file");
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_FALSE(refused([](UnstructuredMesh&) {}));
  EXPECT_TRUE(refused([](UnstructuredMesh& m) {
    for (std::int32_t& n : array<Integers>(m, "vertex row counts")) n = 0;
    array<Integers>(m, "vertex row bodies").clear();
    array<Doubles>(m, "vertex rows").clear();
  }));
  EXPECT_TRUE(refused([](UnstructuredMesh& m) { array<Doubles>(m, "vertex radius")[1] = std::nan(""); }));
  EXPECT_TRUE(
      refused([](UnstructuredMesh& m) { array<Doubles>(m, "vertex signed distances")[0] = INFINITY; }));
  EXPECT_TRUE(refused([](UnstructuredMesh& m) { array<Integers>(m, "vertex interfaces")[0] = 99; }));
  EXPECT_TRUE(refused([](UnstructuredMesh& m) { array<Integers>(m, "interface bodies").pop_back(); }));
  EXPECT_TRUE(refused([](UnstructuredMesh& m) {
    auto& sides = array<Integers>(m, "interface bodies");
    sides[0] = sides[1];
  }));
  EXPECT_TRUE(refused([](UnstructuredMesh& m) { m.points[2].y = std::nan(""); }));
  EXPECT_TRUE(refused([](UnstructuredMesh& m) { std::swap(m.connectivity[0], m.connectivity[1]); }));
  EXPECT_TRUE(refused([](UnstructuredMesh& m) { m.connectivity[3] = 1u << 30; }));
}

/// Trees of vertices are built when they are first needed, in a parallel loop, while other threads ask for
/// them.
TEST(Resampler, NearestVertexOnManyRoots) {
  Scene scene = make_scene("plate");
  InterfaceMesh mesh = scene_interfaces(scene, 0.1);
  const ResamplingSource source = make_mesh_source(mesh, {{-3, -3, 0.4}, {4, 4, 0.6}});
  ResamplingOptions options;
  options.interface_error = 0.2;
  options.distance = DistanceMode::kNearestVertex;
  options.certify = false;
  Resampler resampler(source, options);
  ASSERT_GT(resampler.hierarchy().vertex_count(), 1000u);
  resampler.refine();
  EXPECT_NO_THROW(test::validate(resampler.hierarchy()));
}

/// Small cells at an interface may have none of its vertices near their corners; they are not split for that
/// reason.
TEST(Resampler, NearestVertexSplitsNoCellsBelowTheError) {
  const ResamplingSource source =
      make_mesh_source(scene_interfaces(make_scene("voronoi10"), 0.3), {{0, 0, 0}, {1, 1, 1}});
  ResamplingOptions options;
  options.interface_error = 0.02;
  options.distance = DistanceMode::kNearestVertex;
  options.certify = false;
  options.max_tetrahedra = 500'000;
  Resampler resampler(source, options);
  resampler.refine();
  const auto& hierarchy = resampler.hierarchy();
  EXPECT_LT(hierarchy.leaf_count(), *options.max_tetrahedra);
  double smallest = 1;
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    const auto v = hierarchy.vertices(t);
    const Tetrahedron cell({hierarchy.position(v[0]), hierarchy.position(v[1]), hierarchy.position(v[2]),
                            hierarchy.position(v[3])});
    smallest = std::min(smallest, cell.diameter());
  });
  EXPECT_GE(smallest, 0.5 * options.interface_error);
}

/// A layer that is thinner than the sites' spacing still has fields, which come from sites that hold some of
/// its material.
TEST(GridFieldSource, ThinLayersHaveMixedFields) {
  MultiMaterialData data;
  data.source = "layer";
  data.grid.centering = Centering::kCells;
  for (auto& nodes : data.grid.nodes) {
    for (int i = 0; i <= 8; ++i) nodes.push_back(i);
  }
  data.materials = {"around", "layer", "nowhere"};
  data.fractions.resize(3);
  const std::size_t count = data.grid.site_count();
  for (auto& f : data.fractions) f.assign(count, 0);
  Field field{"f", "", 1, std::vector<float>(count), {}};
  for (std::size_t site = 0; site < count; ++site) {
    const bool layer = site % 8 == 4;
    data.fractions[MaterialId(1)][site] = layer ? 0.4f : 0;
    data.fractions[MaterialId(0)][site] = layer ? 0.6f : 1;
    field.values.set(site, layer ? 7 : 3);
  }
  data.fields.push_back(field);
  const GridFieldSource source(data, std::vector<MaterialId>(count, MaterialId(0)));
  double value = 0;
  source.values(MaterialId(1), {4.5, 2.2, 3.1}, {&value, 1});
  EXPECT_NEAR(value, 7, 1e-6);
  source.values(MaterialId(0), {1.5, 2.2, 3.1}, {&value, 1});
  EXPECT_NEAR(value, 3, 1e-6);
  source.values(MaterialId(2), {4.5, 2.2, 3.1}, {&value, 1});
  EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace adamas
