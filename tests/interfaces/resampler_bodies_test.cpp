#include <gtest/gtest.h>

#include "core/geometry/tetrahedron.h"
#include "tests/interfaces/hierarchy_validation.h"
#include "tests/interfaces/network_meshes.h"
#include "tests/interfaces/resampler_scenes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::ResampledScene;
using test::SceneCase;

/// Returns a box of material 1 within material 0.
InterfaceMesh box_mesh(const Box3& box) {
  InterfaceMesh mesh = test::mesh_with_materials(2);
  const Vec3 size = box.size();
  const Vec3 e[3] = {{size.x, 0, 0}, {0, size.y, 0}, {0, 0, size.z}};
  for (std::size_t a = 0; a < 3; ++a) {
    const Vec3 &u = e[(a + 1) % 3], &v = e[(a + 2) % 3];
    test::add_patch(mesh, box.min, v, u, MaterialId(0), MaterialId(1), 2);
    test::add_patch(mesh, box.min + e[a], u, v, MaterialId(0), MaterialId(1), 2);
  }
  return mesh;
}

void expect_bodies_kept(const Resampler& resampler) {
  const BodyReport* report = resampler.body_report();
  ASSERT_NE(report, nullptr);
  EXPECT_TRUE(report->comparable);
  EXPECT_TRUE(report->contacts.empty());
  for (BodyId b(0); b.value < report->input.size(); ++b.value) {
    EXPECT_EQ(report->mesh[b].pieces, report->input[b].pieces) << b.value;
    EXPECT_EQ(report->mesh[b].euler, report->input[b].euler) << b.value;
  }
}

/// Layers thinner than the error are neither torn nor lost, and the regions on their two sides do not touch.
TEST(ResampledBodies, ThinLayersBetweenOthersDoNotTear) {
  for (const std::string name : {"shell3", "shell2"}) {
    SCOPED_TRACE(name);
    SceneCase c;
    c.name = name;
    c.meshes = true;
    c.options.interface_error = 0.1;
    const ResampledScene scene(c);
    expect_bodies_kept(*scene.resampler);
    test::expect_laws(scene);
  }
}

/// A plate of half the error's thickness ends inside the domain, with one body all round it, so cells must
/// become smaller than its thickness. A limit of distances alone would leave it in pieces.
TEST(ResampledBodies, ThinPlatesDoNotTear) {
  const InterfaceMesh mesh = box_mesh({{0.21, 0.32, 0.47}, {0.73, 0.81, 0.52}});
  const ResamplingSource source = make_mesh_source(mesh, test::unit_box(), nullptr);
  ResamplingOptions options;
  options.interface_error = 0.1;
  Resampler resampler(source, options);
  resampler.refine();
  expect_bodies_kept(resampler);
  // Surfaces are not used here: every line across the plate, away from its rim, meets the plate.
  for (int i = 0; i <= 30; ++i) {
    for (int j = 0; j <= 30; ++j) {
      bool met = false;
      for (int k = 0; k <= 100; ++k) {
        const Vec3 p{0.41 + 0.12 * i / 30, 0.52 + 0.09 * j / 30, 0.39 + 0.21 * k / 100};
        met = met || source.network->table().material(resampler.owner_at(p)) == MaterialId(1);
      }
      EXPECT_TRUE(met) << i << " " << j;
    }
  }
}

/// A plate, given by volume fractions, that a limit of distances alone leaves torn is whole after mending,
/// and as near to the input as was wanted.
TEST(ResampledBodies, TornPlatesAreMended) {
  SceneCase c;
  c.name = "plate";
  c.cells = 20;
  c.options.interface_error = 0.02 * std::sqrt(3.0);
  const ResampledScene scene(c);
  expect_bodies_kept(*scene.resampler);
  ASSERT_TRUE(scene.resampler->certificate());
  EXPECT_LE(scene.resampler->certificate()->materials.upper, c.options.interface_error);
  test::expect_laws(scene);
}

/// The topology of the shells is known: there are two spheres, and a layer between them.
TEST(ResampledBodies, HaveTheTopologyOfTheScene) {
  SceneCase c;
  c.name = "shell3";
  c.meshes = true;
  c.options.interface_error = 0.05;
  const ResampledScene scene(c);
  const BodyReport* report = scene.resampler->body_report();
  ASSERT_NE(report, nullptr);
  for (BodyId b(0); b.value < 3; ++b.value) {
    const bool between = scene.source.materials[scene.table().material(b)] == "shell";
    EXPECT_EQ(report->input[b], (BodyTopology{1, between ? 4 : 2}));
    EXPECT_EQ(report->mesh[b], report->input[b]);
  }
}

/// Leaves list the triangles that meet them, although refinement for bodies that did not help was undone.
/// Every tenth leaf is checked.
TEST(ResampledBodies, LeavesAreSoundAfterRefinementWasTakenBack) {
  SceneCase c;
  c.name = "shell3";
  c.cells = 8;
  c.options.interface_error = 0.12;
  const ResampledScene scene(c);
  const Resampler& resampler = *scene.resampler;
  const InterfaceNetwork& network = *scene.source.network;
  const auto& hierarchy = resampler.hierarchy();
  test::validate(hierarchy);
  std::size_t number = 0;
  hierarchy.for_each_leaf([&](TetrahedronId t) {
    if (++number % 10 != 0) return;
    const auto v = hierarchy.vertices(t);
    const Tetrahedron cell({hierarchy.position(v[0]), hierarchy.position(v[1]), hierarchy.position(v[2]),
                            hierarchy.position(v[3])});
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < network.triangles().size(); ++i) {
      const auto& x = network.triangle_corners(i);
      if (meets(cell, x[0], x[1], x[2])) expected.push_back(i);
    }
    const CellRecord& record = hierarchy.payload(t);
    std::vector<std::uint32_t> listed = record.triangles;
    std::sort(listed.begin(), listed.end());
    EXPECT_EQ(listed, expected);
    EXPECT_TRUE(record.evaluated);
  });
}

/// Conservation preserves the volumes, both as sums over cells and as enclosed by surfaces, and the distances
/// when they are measured anew.
TEST(ConservedVolumes, AgreeWithTheInput) {
  for (const std::string name : {"sphere", "tjunction", "voronoi10", "reflex"}) {
    for (const bool meshes : {false, true}) {
      SCOPED_TRACE(name + (meshes ? " from meshes" : " from fractions"));
      SceneCase c;
      c.name = name;
      c.seed = 2;
      c.cells = 5;
      c.meshes = meshes;
      c.options.interface_error = 0.1;
      c.options.conserve = true;
      const ResampledScene scene(c);
      const double whole = scene.source.box.volume();
      for (MaterialId m(0); m.value < scene.source.materials.size(); ++m.value)
        EXPECT_NEAR(scene.material_volume(scene.source.materials[m]), scene.source.volumes[m], 1e-9 * whole);
      test::expect_laws(scene);
      EXPECT_LE(scene.resampler->certificate()->materials.upper, c.options.interface_error * (1 + 1e-12));
    }
  }
}

/// Where interfaces move only as far as no body changes by it, bounds of distances follow the moves: they
/// hold for what is measured anew, and bodies are those without.
TEST(ConservedVolumes, BoundsFollowMoves) {
  SceneCase c;
  c.name = "sphere";
  c.cells = 16;
  c.options.interface_error = 0.02;
  const ResampledScene without(c);
  c.options.conserve = true;
  const ResampledScene with(c);
  ASSERT_NE(with.extracted().mesh.points, without.extracted().mesh.points);
  const InterfaceCertificate& certificate = *with.resampler->certificate();
  EXPECT_LE(certificate.upper(), c.options.interface_error * (1 + 1e-12));
  InterfaceComparison anew(with.source, c.options.interface_error);
  anew.measure(with.extracted().mesh, SilentProgress::instance());
  const InterfaceCertificate measured = anew.finish(SilentProgress::instance());
  EXPECT_LE(measured.materials.lower, certificate.materials.upper * (1 + 1e-9));
  EXPECT_LE(certificate.materials.lower, measured.materials.upper * (1 + 1e-9));
  const BodyReport &after = *with.resampler->body_report(), &before = *without.resampler->body_report();
  EXPECT_EQ(after.contacts, before.contacts);
  for (BodyId b(0); b.value < after.mesh.size(); ++b.value) {
    EXPECT_EQ(after.mesh[b].pieces, before.mesh[b].pieces);
    EXPECT_EQ(after.mesh[b].euler, before.mesh[b].euler);
  }
}

/// Without conservation the volumes differ, so the test above can fail.
TEST(ConservedVolumes, DifferWithoutConservation) {
  SceneCase c;
  c.name = "sphere";
  c.options.interface_error = 0.06;
  const ResampledScene scene(c);
  const double whole = scene.source.box.volume();
  EXPECT_GT(std::abs(scene.material_volume(scene.source.materials[MaterialId(1)]) -
                     scene.source.volumes[MaterialId(1)]),
            1e-5 * whole);
}

TEST(ConservedVolumes, OnOneThreadAndOnTwo) {
  std::vector<std::vector<Vec3>> points;
  for (const unsigned threads : {1u, 2u}) {
    set_thread_limit(threads);
    SceneCase c;
    c.name = "voronoi10";
    c.cells = 5;
    c.options.interface_error = 0.12;
    c.options.conserve = true;
    points.push_back(ResampledScene(c).extracted().mesh.points);
  }
  set_thread_limit(0);
  EXPECT_EQ(points[0], points[1]);
}

}  // namespace
}  // namespace adamas
