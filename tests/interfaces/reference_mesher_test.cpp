#include "interfaces/comparison/reference_mesher.h"

#include <cmath>

#include "interfaces/comparison/box_stitching.h"
#include "interfaces/comparison/element_errors.h"
#include "interfaces/comparison/region_naming.h"
#include "interfaces/resampling/resampler.h"
#include "tests/interfaces/complex_volumes.h"
#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/surface_distance.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

MesherOptions mesher() {
  MesherOptions options;
  options.program = ADAMAS_REFERENCE_PROGRAM;
  options.limits.seconds = 120;
  return options;
}

/// Returns the stitched network of a scene's true interfaces.
PiecewiseLinearComplex complex_of(const ResamplingSource& source) {
  const InterfaceNetwork& network = *source.network;
  std::vector<BodyTriangle> triangles;
  for (std::uint32_t t = 0; t < network.triangles().size(); ++t) {
    const auto& interface = network.interface(network.interface_of(t));
    triangles.push_back({network.triangles()[t], interface.a, interface.b});
  }
  return stitch_to_box(
      "scene", network.points(), triangles, source.box, 1e-10,
      [&](const Vec3& p) { return source.body_at(p, nullptr); }, ADAMAS_REFERENCE_PROGRAM);
}

struct Given {
  explicit Given(const std::string& name, double resolution)
      : scene(make_scene(name)),
        data(sample_scene(scene, {8, 8, 8})),
        mesh(scene_interfaces(scene, resolution)),
        source(make_mesh_source(mesh, scene.box(), &data)),
        complex(complex_of(source)) {}
  Scene scene;
  MultiMaterialData data;
  InterfaceMesh mesh;
  ResamplingSource source;
  PiecewiseLinearComplex complex;
};

/// Expects that faces of a single tetrahedron lie in the box's sides, and that tetrahedra fill the box.
void expect_conforming(const ConformingMesh& mesh, const Box3& box) {
  const auto neighbours = find_neighbours(mesh.tetrahedra, "mesh");
  double sum = 0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto x = mesh.corners(t);
    const double volume = signed_volume(x[0], x[1], x[2], x[3]);
    EXPECT_GE(volume, 0);
    sum += volume;
    for (std::size_t i = 0; i < 4; ++i) {
      if (neighbours[t][i] != kNoNeighbour) continue;
      int sides = 0;
      for (int axis = 0; axis < 3; ++axis) {
        for (const double level : {box.min[axis], box.max[axis]}) {
          bool on = true;
          for (std::size_t k = 1; k < 4; ++k) on = on && std::abs(x[(i + k) % 4][axis] - level) < 1e-9;
          sides += on ? 1 : 0;
        }
      }
      EXPECT_EQ(sides, 1);
    }
  }
  EXPECT_NEAR(sum, box.volume(), 1e-9 * box.volume());
}

class TetGenScenes : public ::testing::TestWithParam<std::string> {};

TEST_P(TetGenScenes, FillTheComplex) {
  const Given given(GetParam(), 1.0 / 8);
  const ReferenceResult result = mesh_by_tetgen(given.complex, "zpMq1.414Q", mesher());
  if (result.failure.find("without TetGen") != std::string::npos) GTEST_SKIP() << result.failure;
  ASSERT_EQ(result.failure, "");
  expect_conforming(result.mesh, given.source.box);
  const std::size_t bodies = given.source.network->table().body_count();
  const auto found = body_volumes(result.mesh, bodies), known = enclosed_volumes(given.complex, bodies);
  // Without M, TetGen joins facets that are coplanar but for a tenth of a degree.
  for (BodyId b(0); b.value < bodies; ++b.value) EXPECT_NEAR(found[b], known[b], 1e-9) << "body " << b.value;
  EXPECT_GT(result.seconds, 0);
  EXPECT_GT(result.peak_memory_bytes, std::size_t{1} << 20);
  // A field that is constant in each material is exact everywhere up to the single precision of the data.
  const auto vertices = fields_at_vertices(result.mesh, given.source);
  const ElementErrors errors =
      measure_element_errors(given.source, measured_cells(result.mesh, vertices), 0.01);
  const auto& fields = given.source.fields->fields();
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (fields[f].name != "constant") continue;
    const auto figures = errors.figures(std::vector<char>(errors.cells.size(), 1));
    EXPECT_GT(figures[f].all.count(), 400u);
    EXPECT_LT(figures[f].all.max, 1e-5 * (fields[f].max - fields[f].min));
  }
}

INSTANTIATE_TEST_SUITE_P(Reference, TetGenScenes, ::testing::Values("sphere", "tjunction", "voronoi10"));

TEST(Mesh3, KeepsTheDistanceThatWasAsked) {
  const Given given("sphere", 1.0 / 24);
  Mesh3Criteria criteria;
  criteria.facet_distance = 0.01;
  const ReferenceResult result = mesh_by_mesh3(given.complex, criteria, mesher());
  ASSERT_EQ(result.failure, "");
  const auto volumes = body_volumes(result.mesh, 2);
  EXPECT_GT(volumes[BodyId(0)], 0);
  EXPECT_GT(volumes[BodyId(1)], 0);
  std::vector<test::TriangleIndices> input;
  for (const InterfaceTriangle& t : given.mesh.triangles) input.push_back(t.points);
  const auto faces = interface_faces(result.mesh);
  const double distance =
      test::sampled_distance(result.mesh.points, faces, given.mesh.points, input, given.source.box, 4000, 1);
  // The criterion limits the distance at the centres of facets' circles, and these are seldom the worst
  // points.
  EXPECT_LT(distance, 1.5 * criteria.facet_distance);
  const TwoSidedDistance bound = measure_distance(given.source, result.mesh.points, faces, 0.01);
  EXPECT_GE(bound.greatest() * (1 + 1e-9), distance);
  EXPECT_LT(bound.greatest(), 1.2 * distance);
}

TEST(Mesh3, IsTheSameEveryTime) {
  const Given given("tjunction", 1.0 / 8);
  Mesh3Criteria criteria;
  criteria.facet_distance = 0.05;
  criteria.edge_size = 0.3;
  const ReferenceResult a = mesh_by_mesh3(given.complex, criteria, mesher());
  const ReferenceResult b = mesh_by_mesh3(given.complex, criteria, mesher());
  ASSERT_EQ(a.failure, "");
  EXPECT_EQ(a.mesh.tetrahedra, b.mesh.tetrahedra);
  EXPECT_EQ(a.mesh.points, b.mesh.points);
  EXPECT_EQ(a.mesh.bodies, b.mesh.bodies);
  double sum = 0;
  for (const double volume : body_volumes(a.mesh, 3)) {
    EXPECT_GT(volume, 0.1);
    sum += volume;
  }
  EXPECT_NEAR(sum, 1, 0.01);
}

/// Two tetrahedra with a face between bodies 0 and 1; all other faces are on the box.
struct TwoTetrahedra {
  TwoTetrahedra() {
    complex.source = "two";
    complex.patches = {{BodyId(0), BodyId(1), -1}, {BodyId(), BodyId(0), 0}, {BodyId(), BodyId(1), 1}};
  }
  PiecewiseLinearComplex complex;
  std::vector<std::array<std::uint32_t, 4>> tetrahedra{{0, 1, 2, 3}, {0, 2, 1, 4}};
  std::vector<std::array<std::uint32_t, 3>> marked{{2, 1, 0}, {0, 1, 3}, {1, 2, 4}};
  std::vector<std::uint32_t> patches{0, 1, 2};
  std::vector<BodyId> bodies;
  std::string name() { return name_regions(complex, tetrahedra, marked, patches, bodies); }
};

TEST(RegionNaming, FollowsMarksAndTellsWhatIsLost) {
  TwoTetrahedra two;
  EXPECT_EQ(two.name(), "");
  EXPECT_EQ(two.bodies, (std::vector<BodyId>{BodyId(0), BodyId(1)}));
  TwoTetrahedra one_side;
  one_side.marked.pop_back(), one_side.patches.pop_back();
  EXPECT_EQ(one_side.name(), "");
  EXPECT_EQ(one_side.bodies, (std::vector<BodyId>{BodyId(0), BodyId(1)}));
  TwoTetrahedra no_interface;
  no_interface.marked.erase(no_interface.marked.begin());
  no_interface.patches.erase(no_interface.patches.begin());
  EXPECT_NE(no_interface.name().find("lost"), std::string::npos);
  TwoTetrahedra unknown;
  unknown.marked.resize(1), unknown.patches.resize(1);
  EXPECT_NE(unknown.name().find("no interface bounds"), std::string::npos);
}

TEST(DihedralRange, KnowsSimpleTetrahedra) {
  DihedralRange regular;
  regular.add({Vec3{1, 1, 1}, Vec3{1, -1, -1}, Vec3{-1, 1, -1}, Vec3{-1, -1, 1}});
  EXPECT_NEAR(regular.min, std::acos(1.0 / 3) * 180 / std::acos(-1.0), 1e-12);
  EXPECT_NEAR(regular.max, regular.min, 1e-12);
  DihedralRange corner;
  corner.add({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}});
  EXPECT_NEAR(corner.min, std::acos(1 / std::sqrt(3.0)) * 180 / std::acos(-1.0), 1e-12);
  EXPECT_NEAR(corner.max, 90, 1e-12);
}

TEST(ElementErrors, AreThoseOfTheResampler) {
  test::SceneCase c;
  c.name = "voronoi10";
  c.fields = true;
  c.cells = 5;
  c.options.interface_error = 0.08;
  const test::ResampledScene resampled(c);
  std::vector<FieldError> known(resampled.source.fields->fields().size());
  const auto& hierarchy = resampled.resampler->hierarchy();
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    for (std::size_t f = 0; f < known.size(); ++f) known[f].add(hierarchy.payload(t).fields[f]);
  });
  const double half_width =
      std::max(c.options.interface_error, resampled.resampler->certificate()->networks.upper);
  const ResampledMesh mesh = resampled_mesh(*resampled.resampler);
  const ElementErrors errors = measure_element_errors(resampled.source, measured_cells(mesh), half_width);
  const auto found = errors.figures(std::vector<char>(errors.cells.size(), 0));
  for (std::size_t f = 0; f < known.size(); ++f) {
    EXPECT_EQ(found[f].all.count(), known[f].count());
    EXPECT_EQ(found[f].at_interfaces.count(), 0u);
    EXPECT_EQ(found[f].all.counts, known[f].counts);
    EXPECT_EQ(found[f].all.displaced, known[f].displaced);
    EXPECT_EQ(found[f].all.without_value, known[f].without_value);
    // Where a field comes back exactly, the errors are round-off of its values.
    const double values = resampled.source.fields->fields()[f].max;
    const double count = static_cast<double>(known[f].count());
    EXPECT_NEAR(found[f].all.max, known[f].max, 1e-13 * values);
    EXPECT_NEAR(found[f].all.sum, known[f].sum, 1e-13 * values * count);
  }
}

}  // namespace
}  // namespace adamas
