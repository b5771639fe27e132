// Tests interfaces that hold the fractions of every cell, by laws and by other methods than the program's
// own.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/geometry/ownership_problem.h"
#include "datasets/random_numbers.h"
#include "datasets/scene.h"
#include "datasets/scene_sampling.h"
#include "interfaces/reconstruction/cell_volumes.h"
#include "interfaces/reconstruction/cut_volumes.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/reconstruction/site_cell.h"
#include "tests/support/half_space_fractions.h"
#include "tests/support/sheet_fractions.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

std::array<double, 4> random_values(RandomNumbers& random) {
  std::array<double, 4> v{};
  for (double& x : v) x = random.uniform(-1, 1);
  return v;
}

double positive_by_partition(const std::array<double, 4>& values) {
  OwnershipProblem problem;
  problem.add_candidate(0);
  problem.add_function(values, 0);
  problem.add_candidate(1);
  problem.add_function({0, 0, 0, 0}, 1);
  std::vector<OwnedTetrahedron> parts;
  partition_tetrahedron(problem, parts);
  double volume = 0;
  for (const OwnedTetrahedron& part : parts) {
    if (part.owner == 0) volume += volume_fraction(part.corners);
  }
  return volume;
}

TEST(PositivePart, IsThatOfThePartitionAndGrowsAsItSays) {
  RandomNumbers random(3);
  for (int n = 0; n < 2000; ++n) {
    const std::array<double, 4> values = random_values(random);
    const PositivePart found = positive_part(values);
    EXPECT_NEAR(found.volume, positive_by_partition(values), 1e-12);
    for (std::size_t i = 0; i < 4; ++i) {
      const double step = 1e-6;
      std::array<double, 4> more = values, less = values;
      more[i] += step, less[i] -= step;
      const bool turns = std::abs(values[i]) < 2 * step;
      if (!turns) {
        EXPECT_NEAR((positive_part(more).volume - positive_part(less).volume) / (2 * step), found.growth[i],
                    1e-4 * (1 + std::abs(found.growth[i])));
      }
    }
  }
}

RectilinearGrid grid_of(Centering centering, bool stretched) {
  RectilinearGrid grid;
  grid.centering = centering;
  for (std::size_t a = 0; a < 3; ++a) {
    for (int i = 0; i < 5 + static_cast<int>(a); ++i)
      grid.nodes[a].push_back(stretched ? i + 0.1 * i * i + 0.02 * static_cast<double>(a) * i * i * i
                                        : 0.3 * i);
  }
  return grid;
}

/// The parts of a cell fill it, and values at their corners are those of the linear function that the sites
/// have.
TEST(SiteCells, FillTheirCells) {
  for (const Centering centering : {Centering::kCells, Centering::kPoints}) {
    for (const bool stretched : {false, true}) {
      const RectilinearGrid grid = grid_of(centering, stretched);
      const SiteCells cells(grid);
      SiteCell scratch;
      for (std::size_t k = 0; k < grid.sites(2); ++k) {
        for (std::size_t j = 0; j < grid.sites(1); ++j) {
          for (std::size_t i = 0; i < grid.sites(0); ++i) {
            const SiteCell& cell = cells.at(i, j, k, scratch);
            double sum = 0;
            for (const SiteCell::Part& part : cell.parts) sum += part.volume;
            EXPECT_NEAR(sum, 1, 1e-9);
            for (const SiteCell::Node& node : cell.nodes) {
              double weights = 0;
              for (const double w : node.weights) weights += w;
              EXPECT_NEAR(weights, 1, 1e-12);
            }
          }
        }
      }
    }
  }
}

/// The reconstruction's owners of random points in a cell agree with the cell's fractions.
TEST(VolumeCorrection, CellsHoldTheirFractionsByCountedPoints) {
  for (const char* name : {"sphere", "voronoi10", "reflex", "tjunction"}) {
    SCOPED_TRACE(name);
    const std::size_t n = 12;
    const MultiMaterialData data = sample_scene(make_scene(name, 2), {n, n, n}, {3, false});
    const Reconstruction reconstruction(data);
    const auto& grid = data.grid;
    RandomNumbers random(17);
    constexpr int kSamples = 4000;
    int cells = 0;
    for (int turn = 0; turn < 4000 && cells < 40; ++turn) {
      const std::array<std::size_t, 3> at{random.below(n), random.below(n), random.below(n)};
      const std::size_t site = grid.site_index(at[0], at[1], at[2]);
      MaterialId most(0);
      for (MaterialId m(1); m.value < data.materials.size(); ++m.value) {
        if (data.fractions[m][site] > data.fractions[most][site]) most = m;
      }
      const auto wanted = static_cast<double>(data.fractions[most][site]);
      if (wanted > 0.95) continue;
      ++cells;
      int inside = 0;
      for (int s = 0; s < kSamples; ++s) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) {
          const auto& x = grid.nodes[static_cast<std::size_t>(axis)];
          const std::size_t i = at[static_cast<std::size_t>(axis)];
          p[axis] = random.uniform(x[i], x[i + 1]);
        }
        inside += reconstruction.body_materials()[reconstruction.body_at(p)] == most ? 1 : 0;
      }
      // The tolerance is five standard deviations plus the error that a cell may have.
      const double deviation = std::sqrt(wanted * (1 - wanted) / kSamples);
      EXPECT_NEAR(inside / static_cast<double>(kSamples), wanted, 5 * deviation + 2e-3);
    }
    EXPECT_GE(cells, 10);
  }
}

/// Expects the right totals. Fractions in single precision do not quite fill the domain.
void expect_totals(const Reconstruction& found, double domain) {
  double sum = 0;
  for (const double v : found.volume_input()) sum += v;
  EXPECT_NEAR(sum, domain, 1e-7 * domain);
  for (MaterialId m(0); m.value < found.volume_input().size(); ++m.value)
    EXPECT_NEAR(found.volume_reconstructed()[m], found.volume_wanted()[m] * domain / sum, 1e-9 * domain);
  // Dispersed volumes are reported, and nothing else makes a difference.
  double dispersed = 0;
  for (const double volume : found.findings().dispersed) dispersed += volume;
  for (MaterialId m(0); m.value < found.volume_input().size(); ++m.value)
    EXPECT_NEAR(found.volume_wanted()[m], found.volume_input()[m], dispersed + 1e-12 * domain);
}

TEST(VolumeCorrection, TotalsAndMostCellsAreRight) {
  struct Case {
    const char* name;
    std::size_t cells;
    double off;  // greatest part of the mixed cells that may be off
  };
  for (const Case& c : {Case{"sphere", 32, 0.01},
                        {"sphere", 16, 0.01},
                        {"voronoi10", 33, 0.01},
                        {"reflex", 16, 0.01},
                        {"tjunction", 16, 0.01}}) {
    SCOPED_TRACE(c.name);
    const MultiMaterialData data = sample_scene(make_scene(c.name), {c.cells, c.cells, c.cells}, {3, false});
    const Reconstruction found(data);
    expect_totals(found, data.grid.domain().volume());
    const CellAgreement& agreement = found.agreement();
    EXPECT_LE(static_cast<double>(agreement.cells_off), c.off * static_cast<double>(agreement.mixed_cells));
    EXPECT_LT(agreement.mean_difference, 5e-4);
    EXPECT_LT(agreement.greatest_difference, 0.03);
    EXPECT_LE(static_cast<double>(agreement.full_cells_off),
              0.01 * static_cast<double>(agreement.mixed_cells));
    EXPECT_LT(agreement.greatest_in_full_cell, 0.01);
  }
}

/// The totals are right even where not all cells can be.
TEST(VolumeCorrection, TotalsOfAllScenesAreRight) {
  for (const std::string& name : scene_names()) {
    for (const std::size_t n : {5, 10}) {
      SCOPED_TRACE(name + " " + std::to_string(n));
      const MultiMaterialData data = sample_scene(make_scene(name, 4), {n, n + 1, n}, {2, false});
      const Reconstruction found(data);
      expect_totals(found, data.grid.domain().volume());
    }
  }
}

/// The totals are right even where sheets between other materials end at the domain's boundary.
TEST(VolumeCorrection, TotalsOfSheetsAtTheBoundaryAreRight) {
  const MultiMaterialData data = sample_scene(make_scene("random", 2), {24, 24, 24}, {2, false});
  expect_totals(Reconstruction(data), data.grid.domain().volume());
}

/// A thin shell between two materials is closed, is one body, and has its volume.
TEST(VolumeCorrection, AThinShellIsWhole) {
  const auto shell = [](const Vec3& p) { return distance(p, Vec3{0.51, 0.5, 0.49}) - 0.35; };
  const MultiMaterialData data = test::sheet_fractions(24, 0.6, shell, test::OtherSide::kThirdMaterial);
  const Reconstruction found(data);
  EXPECT_EQ(found.body_materials().size(), 3u);
  expect_totals(found, data.grid.domain().volume());
}

/// Returns the greatest and the mean distance, in cells, of the surface's vertices from the true sphere.
std::array<double, 2> sphere_distances(std::size_t n) {
  const Scene scene = make_scene("sphere");
  const Reconstruction found(sample_scene(scene, {n, n, n}, {4, false}));
  const SceneSphere& sphere = scene.spheres()[0];
  std::array<double, 2> result{};
  for (const Vec3& p : found.mesh().points) {
    const double d = std::abs(distance(p, sphere.center) - sphere.radius) * static_cast<double>(n);
    result[0] = std::max(result[0], d);
    result[1] += d / static_cast<double>(found.mesh().points.size());
  }
  return result;
}

TEST(VolumeCorrection, SpheresAreOfSecondOrder) {
  const auto coarse = sphere_distances(16), middle = sphere_distances(32), fine = sphere_distances(64);
  std::printf("sphere, cells: greatest %.4f %.4f %.4f, mean %.4f %.4f %.4f\n", coarse[0], middle[0], fine[0],
              coarse[1], middle[1], fine[1]);
  EXPECT_LE(middle[0], 0.06);
  EXPECT_LE(middle[1], 0.012);
  EXPECT_GT(std::log2(coarse[1] / middle[1]), 0.9);
  EXPECT_GT(std::log2(middle[1] / fine[1]), 0.9);
  EXPECT_GT(0.5 * std::log2(coarse[0] / fine[0]), 0.7);
}

/// Planes are exact up to the single precision of the fractions and to traces that are set to zero.
TEST(VolumeCorrection, PlanesArePlanes) {
  for (const bool stretched : {false, true}) {
    for (const Vec3& way :
         {Vec3{0.6, 0.64, 0.48}, Vec3{-0.3, 0.5, 0.81}, Vec3{0.1, 0.9, 0.05}, Vec3{1, 1, -1}}) {
      const Vec3 normal = normalized(way);
      const test::HalfSpace half_space = test::half_space_fractions(normal, 12, stretched);
      const Reconstruction found(half_space.data);
      EXPECT_EQ(found.body_materials().size(), 2u);
      for (const Vec3& p : found.mesh().points)
        EXPECT_NEAR(dot(normal, p), half_space.offset, 1e-7 / 12)
            << normal.x << ' ' << normal.y << ' ' << stretched;
    }
  }
}

/// The data have one material everywhere, or two without a mixed cell.
TEST(VolumeCorrection, NothingToCorrect) {
  MultiMaterialData data;
  data.source = "bricks";
  for (auto& x : data.grid.nodes) x = {0, 1, 2, 3};
  data.grid.centering = Centering::kCells;
  data.materials.push_back("a");
  data.materials.push_back("b");
  data.fractions.assign(2, std::vector<float>(27, 0.0f));
  for (std::size_t site = 0; site < 27; ++site) data.fractions[MaterialId(0)][site] = 1;
  EXPECT_TRUE(Reconstruction(data).mesh().triangles.empty());
  for (std::size_t site = 0; site < 9; ++site)
    std::swap(data.fractions[MaterialId(0)][site], data.fractions[MaterialId(1)][site]);
  const Reconstruction found(data);
  EXPECT_EQ(found.agreement().mixed_cells, 0u);
  for (const Vec3& p : found.mesh().points) EXPECT_NEAR(p.z, 1, 1e-9);
}

}  // namespace
}  // namespace adamas
