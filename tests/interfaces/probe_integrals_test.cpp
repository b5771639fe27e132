#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/tetrahedron.h"
#include "interfaces/mesh/interface_extraction.h"
#include "interfaces/probe/material_integrals.h"
#include "tests/interfaces/cross_section_meshes.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

using test::make_scene_mesh;
using test::SceneMesh;

TEST(ProbeIntegrals, VolumesAreThoseOfTheBodies) {
  for (const char* name : {"sphere", "plate", "tjunction"}) {
    const SceneMesh scene = make_scene_mesh(name);
    const auto integrals = material_integrals(scene.mesh);
    const auto bodies = body_volumes(scene.mesh.table, scene.mesh.cell_set());
    IdVector<MaterialId, double> expected(scene.mesh.materials.size(), 0.0);
    for (BodyId b(0); b.value < bodies.size(); ++b.value) expected[scene.mesh.table.material(b)] += bodies[b];
    double sum = 0;
    for (MaterialId m(0); m.value < expected.size(); ++m.value) {
      EXPECT_NEAR(integrals[m].volume, expected[m], 1e-13) << name;
      sum += integrals[m].volume;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(ProbeIntegrals, LinearFieldsOnPlaneRegionsAreExact) {
  const SceneMesh scene = make_scene_mesh("tjunction");
  const auto integrals = material_integrals(scene.mesh);
  // Regions of plane scenes are parts of the six tetrahedra of the box, cut by the scene's own functions.
  IdVector<MaterialId, double> volume(3, 0.0), expected(3, 0.0);
  const std::array<std::array<int, 3>, 6> orders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (const auto& order : orders) {
    std::array<Vec3, 4> x{};
    for (std::size_t c = 1; c < 4; ++c) x[c] = x[c - 1], x[c][order[c - 1]] = 1;
    OwnershipProblem problem;
    for (const SceneCandidate& candidate : scene.scene.candidates()) {
      problem.add_candidate(candidate.owner.value);
      for (const std::uint32_t f : candidate.functions) {
        const SceneFunction& function = scene.scene.functions()[f];
        problem.add_function(
            {function.value(x[0]), function.value(x[1]), function.value(x[2]), function.value(x[3])}, f);
      }
    }
    std::vector<OwnedTetrahedron> parts;
    partition_tetrahedron(problem, parts);
    for (const OwnedTetrahedron& part : parts) {
      Vec3 center;
      for (const Weights& w : part.corners) {
        for (std::size_t i = 0; i < 4; ++i) center += 0.25 * w[i] * x[i];
      }
      const MaterialId owner(part.owner);
      const double v = std::abs(signed_volume(x[0], x[1], x[2], x[3])) * volume_fraction(part.corners);
      volume[owner] += v;
      expected[owner] += v * scene.scene.field(SceneField::kLinear, owner, center);
    }
  }
  for (MaterialId m(0); m.value < 3; ++m.value) {
    EXPECT_NEAR(integrals[m].volume, volume[m], 1e-9);
    EXPECT_NEAR(integrals[m].volume, scene.scene.volume(m), 1e-9);
    EXPECT_NEAR(integrals[m].integral[0], expected[m], 1e-11);
    EXPECT_NEAR(integrals[m].mean[0], expected[m] / volume[m], 1e-11);
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(integrals[m].integral[2 + c], test::SceneFields::factor(c) * expected[m], 1e-10);
    if (m == MaterialId(0)) {
      EXPECT_NEAR(integrals[m].integral[5], expected[m], 1e-11);
    } else {
      EXPECT_TRUE(std::isnan(integrals[m].integral[5]));
    }
  }
}

TEST(ProbeIntegrals, OfGridsAreSumsOverSites) {
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    MultiMaterialData data;
    data.source = "grid";
    data.grid.nodes = {{{0, 1, 3}, {0, 2}, {0, 1}}};
    data.grid.centering = centering;
    data.materials = {"a", "b", "none"};
    const std::size_t count = data.grid.site_count();
    data.fractions.assign(3, std::vector<float>(count, 0));
    Field mixed{"m", "", 2, {}, {}}, own{"o", "", 1, {}, {}};
    own.material_values.assign(2, {});
    std::vector<float> mixed_values;
    for (std::size_t s = 0; s < count; ++s) {
      data.fractions[MaterialId(0)][s] = s % 2 == 0 ? 1.0f : 0.25f;
      data.fractions[MaterialId(1)][s] = s % 2 == 0 ? 0.0f : 0.75f;
      mixed_values.insert(mixed_values.end(), {2, static_cast<float>(s)});
    }
    mixed.values = std::move(mixed_values);
    own.material_values[MaterialId(0)] = std::vector<double>(count, 5);
    data.fields = {mixed, own};
    double whole = 0, second = 0, part = 0;
    for (std::size_t k = 0, s = 0; k < data.grid.sites(2); ++k) {
      for (std::size_t j = 0; j < data.grid.sites(1); ++j) {
        for (std::size_t i = 0; i < data.grid.sites(0); ++i, ++s) {
          const double v = data.grid.site_volume(i, j, k) * (s % 2 == 0 ? 1 : 0.25);
          whole += data.grid.site_volume(i, j, k);
          part += v;
          second += v * static_cast<double>(s);
        }
      }
    }
    EXPECT_NEAR(whole, 6, 1e-12);
    const auto integrals = material_integrals(data);
    const MaterialIntegral &a = integrals[MaterialId(0)], &b = integrals[MaterialId(1)],
                           &none = integrals[MaterialId(2)];
    EXPECT_NEAR(a.volume, part, 1e-12);
    EXPECT_NEAR(b.volume, whole - part, 1e-12);
    EXPECT_EQ(none.volume, 0);
    EXPECT_TRUE(std::isnan(none.mean[0]));
    EXPECT_NEAR(a.integral[0], 2 * part, 1e-12);
    EXPECT_NEAR(a.integral[1], second, 1e-12);
    EXPECT_NEAR(a.mean[2], 5, 1e-12);
    EXPECT_NEAR(b.mean[0], 2, 1e-12);
    EXPECT_TRUE(std::isnan(b.integral[2]));
  }
}

TEST(ProbeIntegrals, OfTheSamplingAreThoseOfTheScene) {
  const SceneMesh scene = make_scene_mesh("tjunction");
  const auto integrals = material_integrals(*scene.data);
  for (MaterialId m(0); m.value < integrals.size(); ++m.value)
    EXPECT_NEAR(integrals[m].volume, scene.scene.volume(m), 1e-6);
}

TEST(ProbeIntegrals, SameOnAnyNumberOfThreads) {
  const SceneMesh scene = make_scene_mesh("plate");
  set_thread_limit(1);
  const auto one = material_integrals(scene.mesh);
  set_thread_limit(2);
  const auto two = material_integrals(scene.mesh);
  set_thread_limit(0);
  for (MaterialId m(0); m.value < one.size(); ++m.value) {
    EXPECT_EQ(one[m].volume, two[m].volume);
    EXPECT_TRUE(
        std::equal(one[m].integral.begin(), one[m].integral.end(), two[m].integral.begin(), test::same));
  }
}

}  // namespace
}  // namespace adamas
