#include <cstdio>

#include "core/geometry/tetrahedron.h"
#include "datasets/random_numbers.h"
#include "interfaces/reconstruction/grid_flakes.h"
#include "interfaces/reconstruction/site_values.h"
#include "tests/interfaces/resampler_scenes.h"
#include "tests/support/surface_distance.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

/// Returns the volume where a resampled scene of planes gives points to another material than the scene; each
/// point counts for both materials. Each piece of a cell is cut along the scene's own functions.
double symmetric_difference(const test::ResampledScene& resampled) {
  const CellSet cells = resampled.resampler->cells();
  double wrong = 0;
  for (std::size_t c = 0; c < cells.count; ++c) {
    const auto corners = cells.corners(c);
    const Tetrahedron cell(cells.positions(corners));
    CellOwnership ownership;
    cells.ownership(resampled.table(), corners, ownership);
    std::vector<OwnedTetrahedron> pieces;
    if (ownership.pure()) {
      pieces.push_back({ownership.problem.candidates[0].owner,
                        {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
    } else {
      partition_tetrahedron(ownership.problem, pieces);
    }
    for (const OwnedTetrahedron& piece : pieces) {
      std::array<Vec3, 4> places;
      for (std::size_t i = 0; i < 4; ++i) places[i] = cell.point(piece.corners[i]);
      OwnershipProblem truth;
      for (const SceneCandidate& candidate : resampled.scene.candidates()) {
        truth.add_candidate(candidate.owner.value);
        for (const std::uint32_t f : candidate.functions) {
          const SceneFunction& function = resampled.scene.functions()[f];
          truth.add_function({function.value(places[0]), function.value(places[1]), function.value(places[2]),
                              function.value(places[3])},
                             f);
        }
      }
      std::vector<OwnedTetrahedron> parts;
      partition_tetrahedron(truth, parts);
      const double volume = cell.volume * volume_fraction(piece.corners);
      const MaterialId material = resampled.table().material(BodyId(piece.owner));
      for (const OwnedTetrahedron& part : parts) {
        if (part.owner != material.value) wrong += 2 * volume * volume_fraction(part.corners);
      }
    }
  }
  return wrong;
}

TEST(Reconstruction, TheTJunctionFromMeshesIsExact) {
  test::SceneCase c;
  c.name = "tjunction";
  c.meshes = true;
  c.options.interface_error = 0.1;
  EXPECT_LT(symmetric_difference(test::ResampledScene(c)), 1e-9);
}

/// Returns the error for the scene in a box whose x and y axes may be reversed, so that the diagonals that
/// divide cells have all directions relative to the planes.
double reconstruction_error(bool turn_x, bool turn_y) {
  const Scene scene = make_scene("tjunction");
  MultiMaterialData data = sample_scene(scene, {3, 5, 7}, {3, false});
  for (auto& fractions : data.fractions) {
    const SiteArray<float> given = fractions;
    for (std::size_t site = 0; site < given.size(); ++site) {
      const std::size_t i = site % 3, j = site / 3 % 5, k = site / 15;
      fractions[data.grid.site_index(turn_x ? 2 - i : i, turn_y ? 4 - j : j, k)] = given[site];
    }
  }
  const ResamplingSource source = make_grid_source(data);
  RandomNumbers random(1);
  constexpr int kSamples = 100000;
  int wrong = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 p = random.point(scene.box());
    const Vec3 q{turn_x ? 1 - p.x : p.x, turn_y ? 1 - p.y : p.y, p.z};
    wrong += source.network->table().material(source.body_at(q, nullptr)) == scene.owner(p) ? 0 : 1;
  }
  return 2.0 * wrong / kSamples;
}

/// The error depends on the directions of the diagonals.
TEST(Reconstruction, OfTheTJunctionFromFractions) {
  double mean = 0, least = 1;
  for (const bool turn_x : {false, true}) {
    for (const bool turn_y : {false, true}) {
      const double error = reconstruction_error(turn_x, turn_y);
      std::printf("tjunction from fractions 3x5x7: symmetric difference %.4f\n", error);
      mean += error / 4;
      least = std::min(least, error);
    }
  }
  EXPECT_LT(least, 0.1);
  EXPECT_LT(mean, 0.13);
}

/// Three regions are three bodies on any grid, although they have slivers that hold no site.
TEST(Reconstruction, SliversRoundATripleLineAreNoBodies) {
  for (const std::size_t cells : {9, 10, 12, 13, 16}) {
    SCOPED_TRACE(cells);
    test::SceneCase c;
    c.name = "tjunction";
    c.cells = cells;
    c.options.interface_error = 0.05;
    const test::ResampledScene resampled(c);
    EXPECT_EQ(resampled.table().body_count(), 3u);
    EXPECT_LE(resampled.resampler->certificate()->networks.upper, 0.05);
    EXPECT_LT(resampled.resampler->hierarchy().leaf_count(), 2000u);
    test::expect_laws(resampled);
  }
}

/// Expects that the boundary of every region closes, that its volume is that of its parts, and that no
/// triangle has one body on both sides.
void expect_closed(const Reconstruction& reconstruction, const Box3& box) {
  const InterfaceMesh& mesh = reconstruction.mesh();
  if (mesh.triangles.empty()) return;
  const double tolerance = 1e-11 * box.diagonal();
  const auto by_material = test::sided_by_material(mesh);
  std::vector<test::SidedTriangle> by_body;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [front, back] = reconstruction.bodies()[t];
    by_body.push_back({mesh.triangles[t].points, front.value, back.value});
    EXPECT_EQ(reconstruction.body_materials()[front], mesh.triangles[t].front);
    EXPECT_EQ(reconstruction.body_materials()[back], mesh.triangles[t].back);
  }
  for (const auto* triangles : std::array{&by_material, &std::as_const(by_body)}) {
    const auto edges = test::check_edges(mesh.points, *triangles, box, tolerance);
    EXPECT_EQ(edges.open, 0u) << edges.first;
    EXPECT_EQ(edges.lonely, 0u) << edges.first;
    EXPECT_EQ(edges.degenerate, 0u);
  }
  // Where an interface passes through the corner, the owner of the corner decides only to which region the
  // volume of the box is added.
  const BodyId corner = reconstruction.body_at(box.max);
  const auto& volumes = reconstruction.volume_reconstructed();
  const auto enclosed = test::enclosed_volumes(mesh.points, by_material, volumes.size(), box,
                                               reconstruction.body_materials()[corner].value, tolerance);
  for (MaterialId m(0); m.value < volumes.size(); ++m.value) {
    EXPECT_NEAR(std::remainder(enclosed[m.value] - volumes[m], box.volume()), 0, 1e-9 * box.volume())
        << "material " << m.value;
  }
}

TEST(Reconstruction, IsClosed) {
  for (const std::string& name : scene_names()) {
    for (const std::size_t n : {3, 7, 10}) {
      SCOPED_TRACE(name + " " + std::to_string(n));
      const Scene scene = make_scene(name, 2);
      const MultiMaterialData data = sample_scene(scene, {n, n, n}, {2, false});
      expect_closed(Reconstruction(data), scene.box());
    }
  }
}

/// If the correction of volumes cuts off flakes that are far smaller than a cell, they are given to
/// neighbours, and volumes stay right: the scenes have one body of each material.
TEST(Reconstruction, FlakesAreNoBodies) {
  struct Case {
    const char* name;
    std::size_t cells, bodies;
  };
  for (const Case& c : {Case{"reflex", 16, 3}, {"shell3", 16, 3}}) {
    SCOPED_TRACE(c.name);
    const Scene scene = make_scene(c.name);
    const MultiMaterialData data = sample_scene(scene, {c.cells, c.cells, c.cells}, {3, false});
    const Reconstruction found(data);
    EXPECT_EQ(found.body_materials().size(), c.bodies);
    expect_closed(found, scene.box());
    const double domain = scene.box().volume();
    for (MaterialId m(0); m.value < found.volume_input().size(); ++m.value)
      EXPECT_NEAR(found.volume_reconstructed()[m], found.volume_input()[m], 1e-9 * domain);
  }
}

/// Small bodies are flakes only if their cells hold far more of the material and show it elsewhere, so drops
/// are none.
TEST(Reconstruction, DropsAreNoFlakes) {
  MultiMaterialData data = sample_scene(make_scene("plate"), {9, 9, 9}, {1, false});
  const std::size_t middle = data.grid.site_index(4, 4, 4);
  const double h = 1.0 / 9;
  // The drop is a tetrahedron of a hundredth of the cell.
  InterfaceMesh mesh;
  mesh.points.assign(4, data.grid.site(4, 4, 4));
  for (int axis = 0; axis < 3; ++axis)
    mesh.points[static_cast<std::size_t>(axis) + 1][axis] += std::cbrt(0.06) * h;
  for (const std::array<std::uint32_t, 3>& corners :
       {std::array<std::uint32_t, 3>{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}})
    mesh.triangles.push_back({corners, MaterialId(0), MaterialId(1)});
  const std::vector<std::array<BodyId, 2>> bodies(4, {BodyId(0), BodyId(1)});
  const IdVector<BodyId, MaterialId> materials{MaterialId(0), MaterialId(1)};
  for (const bool alone : {true, false}) {
    for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
      const float part = site == middle ? 0.01f : alone ? 0.0f : site == 0 ? 0.6f : 0.1f;
      data.fractions[MaterialId(0)][site] = 1 - part;
      data.fractions[MaterialId(1)][site] = part;
    }
    const auto flakes = find_flakes(data, SiteValues(data), mesh, bodies, materials);
    ASSERT_EQ(flakes.size(), alone ? 0u : 1u);
    if (alone) continue;
    EXPECT_EQ(flakes[0].body, BodyId(1));
    EXPECT_EQ(flakes[0].neighbour, BodyId(0));
    EXPECT_EQ(flakes[0].move.cell, middle);
    EXPECT_NEAR(flakes[0].volume, 0.01 * h * h * h, 1e-15);
    InterfaceMesh rest = mesh;
    auto sides = bodies;
    auto kept = materials;
    EXPECT_EQ(drop_flakes(flakes, rest, sides, kept)[BodyId(1)], BodyId(0));
    EXPECT_TRUE(rest.triangles.empty() && sides.empty());
    EXPECT_EQ(kept.size(), 1u);
  }
}

TEST(LongReconstruction, IsClosed) {
  for (const std::size_t n : {21, 24, 31}) {
    SCOPED_TRACE("tjunction " + std::to_string(n));
    const Scene scene = make_scene("tjunction");
    expect_closed(Reconstruction(sample_scene(scene, {n, n, n}, {2, false})), scene.box());
  }
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE("random " + std::to_string(seed));
    const Scene scene = make_scene("random", seed);
    const std::size_t n = 4 + seed % 7;
    expect_closed(Reconstruction(sample_scene(scene, {n, n + 1, n}, {2, false})), scene.box());
  }
}

/// Fractions in steps of a quarter are equal at many sites, so that interfaces run along faces, edges and
/// corners.
class LongEqualFractions : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(LongEqualFractions, AreClosed) {
  RandomNumbers random(GetParam());
  for (int round = 0; round < 8; ++round) {
    SCOPED_TRACE(round);
    MultiMaterialData data = sample_scene(make_scene("voronoi10"), {4, 4, 4}, {1, false});
    data.fields.clear();
    const std::size_t materials = 2 + random.below(4);
    data.materials.resize(materials);
    data.fractions.assign(materials, std::vector<float>(data.grid.site_count(), 0.0f));
    for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
      for (int quarter = 0; quarter < 4; ++quarter)
        data.fractions[MaterialId(random.below(materials))][site] += 0.25f;
    }
    expect_closed(Reconstruction(data), data.grid.domain());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, LongEqualFractions, ::testing::Values(11, 12));

/// The network decides by pseudonormals, and agrees with the reconstruction's own decision, which is exact.
TEST(Reconstruction, AgreesWithItsNetworkAboutBodies) {
  for (const std::string& name : scene_names()) {
    SCOPED_TRACE(name);
    const Scene scene = make_scene(name, 2);
    const std::size_t n = 7;
    const MultiMaterialData data = sample_scene(scene, {n, n, n}, {2, false});
    const ResamplingSource source = make_grid_source(data);
    const InterfaceNetwork& network = *source.network;
    // At this resolution the thinnest layers own no site.
    if (network.triangles().empty()) continue;
    RandomNumbers random(7);
    constexpr int kSamples = 4000;
    int disagree = 0, far = 0;
    for (int i = 0; i < kSamples; ++i) {
      Vec3 p = random.point(scene.box());
      if (i % 2 == 0) {
        // Every second point is close to the interfaces.
        const auto t = static_cast<std::uint32_t>(random.below(network.triangles().size()));
        const auto& corners = network.triangle_corners(t);
        const double u = random.uniform(), v = random.uniform() * (1 - u);
        p = (1 - u - v) * corners[0] + u * corners[1] + v * corners[2] +
            std::pow(10, random.uniform(-4, -1)) / static_cast<double>(n) * random.direction();
        if (!scene.box().contains(p)) continue;
      }
      if (network.body_at(p) == source.body_at(p, nullptr)) continue;
      ++disagree;
      const auto closest = network.tree().closest(p);
      far += std::sqrt(closest->squared_distance) > 1e-6 / static_cast<double>(n) ? 1 : 0;
    }
    EXPECT_EQ(far, 0) << disagree << " of " << kSamples;
  }
}

}  // namespace
}  // namespace adamas
