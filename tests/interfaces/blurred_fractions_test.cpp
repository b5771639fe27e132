// Tests interfaces from blurred fractions and from fractions with errors: distances from the truth, topology
// and totals. Also tests that sharp fractions are recognised as such.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "datasets/fraction_blur.h"
#include "datasets/random_numbers.h"
#include "datasets/scene.h"
#include "datasets/scene_sampling.h"
#include "interfaces/network/body_topology.h"
#include "interfaces/reconstruction/normal_distribution.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/reconstruction/site_box.h"
#include "tests/support/closed_reconstruction.h"

namespace adamas {

using namespace datasets;
using namespace interfaces;

namespace {

constexpr std::size_t kCells = 24;

MultiMaterialData blurred_scene(const char* name, double blur, double noise, std::size_t cells = kCells) {
  SamplingOptions options;
  options.fields = false;
  options.blur = {.blur = blur, .noise = noise};
  options.noise_seed = 5;
  return sample_scene(make_scene(name, 3), {cells, cells, cells}, options);
}

struct Distance {
  double mean = 0, greatest = 0;
};

/// Returns the distances, in cells, of the middles of triangles from the points where two of the scene's
/// materials have the same greatest value.
Distance distance_from_truth(const Reconstruction& found, const Scene& scene, std::size_t cells) {
  Distance result;
  double sum = 0, area = 0;
  for (const InterfaceTriangle& t : found.mesh().triangles) {
    const Vec3 &a = found.mesh().points[t.points[0]], &b = found.mesh().points[t.points[1]],
               &c = found.mesh().points[t.points[2]];
    const Vec3 middle = 1.0 / 3 * (a + b + c);
    // Functions of scenes are signed distances: two differ by twice the distance from where they are equal.
    const double off = 0.5 * std::abs(scene.value(t.front, middle) - scene.value(t.back, middle)) *
                       static_cast<double>(cells),
                 weight = norm(cross(b - a, c - a));
    sum += weight * off, area += weight;
    result.greatest = std::max(result.greatest, off);
  }
  result.mean = sum / area;
  return result;
}

TEST(NormalDistribution, QuantileIsTheInverse) {
  for (const double p : {1e-12, 1e-6, 0.01, 0.3, 0.5, 0.77, 0.999, 1 - 1e-9})
    EXPECT_NEAR(normal_probability(normal_quantile(p)), p, 1e-15 + 1e-13 * p) << p;
}

/// Diffusion has the variance asked for, and preserves sums; on uneven grids it preserves linear functions
/// too.
TEST(SiteBox, DiffusionHasItsVariance) {
  RectilinearGrid grid;
  grid.centering = Centering::kPoints;
  for (auto& nodes : grid.nodes) {
    for (int i = 0; i < 21; ++i) nodes.push_back(i + 0.01 * i * i);
  }
  const SiteBox box(grid, {0, 0, 0}, {21, 21, 21});
  std::vector<float> linear(box.size()), scratch;
  box.for_each([&](std::size_t place, std::size_t site) {
    const Vec3 p = grid.site(site % 21, site / 21 % 21, site / 441);
    linear[place] = static_cast<float>(p.x + 2 * p.y - p.z);
  });
  std::vector<float> spread = linear;
  for (int n = 0; n < 4; ++n) box.diffuse(spread, box.greatest_step(), scratch);
  const auto at = [&](std::size_t i, std::size_t j, std::size_t k) { return i + 21 * (j + 21 * k); };
  EXPECT_NEAR(spread[at(10, 10, 10)], linear[at(10, 10, 10)], 1e-4);

  const RectilinearGrid even =
      RectilinearGrid::uniform({21, 21, 21}, {0, 0, 0}, {1, 1, 1}, Centering::kPoints);
  const SiteBox cube(even, {0, 0, 0}, {21, 21, 21});
  std::vector<float> peak(cube.size(), 0);
  peak[at(10, 10, 10)] = 1;
  for (int n = 0; n < 6; ++n) cube.diffuse(peak, 0.2, scratch);
  double sum = 0, variance = 0;
  for (std::size_t i = 0; i < peak.size(); ++i) {
    sum += static_cast<double>(peak[i]);
    const double x = static_cast<double>(i % 21) - 10;
    variance += x * x * static_cast<double>(peak[i]);
  }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_NEAR(variance, 1.2, 1e-4);
}

/// Sharp fractions are not blurred, and have no errors.
TEST(BlurredFractions, SharpOnesAreSharp) {
  for (const char* name : {"sphere", "voronoi10", "reflex", "tjunction", "plate", "shell3"}) {
    const MultiMaterialData data = blurred_scene(name, 0, 0);
    const SiteValues found(data), told(data, false, {.blur = 0, .error = 0});
    EXPECT_EQ(found.findings().blur_share, 0) << name;
    EXPECT_EQ(found.findings().fraction_error, 0) << name;
    ASSERT_EQ(found.entries().size(), told.entries().size()) << name;
    EXPECT_TRUE(std::equal(found.entries().begin(), found.entries().end(), told.entries().begin(),
                           [](const auto& a, const auto& b) { return a.value == b.value; }))
        << name;
  }
}

TEST(BlurredFractions, WidthsAreReadOff) {
  for (const double blur : {0.5, 1.0, 1.5}) {
    const SiteValues found(blurred_scene("sphere", blur, 0));
    EXPECT_GT(found.findings().blur_share, 0.99);
    EXPECT_NEAR(found.findings().blur_median, std::sqrt(blur * blur + 1.0 / 12), 0.06 * (1 + blur)) << blur;
    const SiteValues noisy(blurred_scene("sphere", blur, 0.02));
    // Noise of two materials is scaled by the root of 1/2 when they are made to add up to 1.
    EXPECT_NEAR(noisy.findings().fraction_error, 0.0141, 0.009) << blur;
  }
}

TEST(BlurredFractions, SurfacesAreWhereTheyWere) {
  struct Case {
    const char* scene;
    double mean, greatest;
  };
  struct Fault {
    double blur, noise;
  };
  for (const Case& c : {Case{"sphere", 0.02, 0.12}, Case{"voronoi10", 0.06, 0.7},
                        Case{"tjunction", 0.06, 0.7}, Case{"reflex", 0.08, 0.7}}) {
    const Scene scene = make_scene(c.scene, 3);
    for (const auto& [blur, noise] : {Fault{0.5, 0}, Fault{1, 0.02}, Fault{1.5, 0}}) {
      const MultiMaterialData data = blurred_scene(c.scene, blur, noise);
      const Reconstruction found(data);
      test::expect_closed_with_totals(found, data);
      EXPECT_EQ(found.body_materials().size(), data.materials.size()) << c.scene << " " << blur;
      const Distance off = distance_from_truth(found, scene, kCells);
      const double allowed = noise > 0 ? 2 : 1;
      EXPECT_LT(off.mean, allowed * c.mean) << c.scene << " " << blur << " " << noise;
      EXPECT_LT(off.greatest, allowed * c.greatest) << c.scene << " " << blur << " " << noise;
    }
  }
}

/// With constant blur in cells, the mean distance falls with the square of the cells' size.
TEST(BlurredFractions, AreOfSecondOrder) {
  const Scene scene = make_scene("sphere", 3);
  std::vector<double> lengths;
  for (const std::size_t cells : {12u, 24u, 48u}) {
    const MultiMaterialData data = blurred_scene("sphere", 1, 0, cells);
    lengths.push_back(distance_from_truth(Reconstruction(data), scene, cells).mean /
                      static_cast<double>(cells));
  }
  EXPECT_LT(lengths[1], lengths[0] / 2.8);
  EXPECT_LT(lengths[2], lengths[1] / 2.8);
}

/// Interfaces are closed on graded grids and on grids of one site along an axis, and are equal to the bit on
/// any number of threads.
TEST(BlurredFractions, OnAnyGridAndNumberOfThreads) {
  for (const std::array<std::size_t, 3> n : {std::array<std::size_t, 3>{14, 9, 11}, {12, 12, 1}, {9, 1, 1}}) {
    MultiMaterialData data;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t i = 0; i <= n[a]; ++i)
        data.grid.nodes[a].push_back(static_cast<double>(i) * (1 + 0.3 * static_cast<double>(i * a)));
    }
    for (const char* name : {"in", "out"}) {
      data.materials.emplace_back(name);
      data.fractions.emplace_back(data.grid.site_count());
    }
    RandomNumbers random(3);
    for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
      const Vec3 p = data.grid.site(site % n[0], site / n[0] % n[1], site / (n[0] * n[1]));
      const double noise = random.uniform(-0.01, 0.01);
      const double f = normal_probability((4.3 + 0.2 * p.y - p.x) / 1.4) + noise;
      data.fractions[MaterialId(0)][site] = static_cast<float>(std::clamp(f, 0.0, 1.0));
      data.fractions[MaterialId(1)][site] = 1 - data.fractions[MaterialId(0)][site];
    }
    SCOPED_TRACE(n[2]);
    set_thread_limit(1);
    const Reconstruction alone(data);
    set_thread_limit(4);
    const Reconstruction together(data);
    set_thread_limit(0);
    test::expect_closed(alone, data.grid.domain());
    if (n[2] > 1) test::expect_closed_with_totals(alone, data);
    EXPECT_GT(alone.findings().blur_share, 0);
    ASSERT_FALSE(alone.mesh().triangles.empty());
    EXPECT_EQ(alone.mesh().points, together.mesh().points);
    EXPECT_EQ(alone.volume_reconstructed(), together.volume_reconstructed());
  }
}

/// A plate whose greatest fraction is far below one half is one closed body, and a shell of a third of a cell
/// is whole, also with noise.
TEST(BlurredFractions, ThinSheetsAreWhole) {
  struct Case {
    const char* scene;
    double blur, noise;
    std::size_t bodies;
  };
  for (const Case& c : {Case{"plate", 1.5, 0, 2}, Case{"shell3", 1.5, 0, 3}, Case{"shell3", 1, 0.02, 3}}) {
    SCOPED_TRACE(c.scene);
    const MultiMaterialData data = blurred_scene(c.scene, c.blur, c.noise, 32);
    float most = 0;
    for (const float f : data.fractions[MaterialId(1)]) most = std::max(most, f);
    if (std::string(c.scene) == "plate") {
      ASSERT_LT(most, 0.35f);
    }
    const Reconstruction found(data);
    test::expect_closed_with_totals(found, data);
    EXPECT_EQ(found.body_materials().size(), c.bodies) << c.blur;
  }
}

/// Where there are only thin sheets, their noise is estimated from second differences.
TEST(BlurredFractions, ErrorsAtThinSheetsAreReadOff) {
  for (const double noise : {0.0, 0.02}) {
    const SiteValues found(blurred_scene("shell3", 1, noise));
    // The two materials of a cell share the noise.
    EXPECT_NEAR(found.findings().fraction_error, noise, noise > 0 ? 0.008 : 0.002);
  }
}

/// A mist far from everything is counted and named by its material. It has no interface unless that is asked
/// for.
TEST(BlurredFractions, AMistIsDispersed) {
  MultiMaterialData data = blurred_scene("sphere", 1, 0);
  data.materials.emplace_back("mist");
  data.fractions.emplace_back(data.grid.site_count(), 0.0f);
  double mist = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    for (std::size_t j = 0; j < kCells; ++j) {
      for (std::size_t i = 0; i < kCells; ++i) {
        const std::size_t site = data.grid.site_index(i, j, k);
        for (MaterialId m(0); m.value < 2; ++m.value) data.fractions[m].data()[site] *= 0.98f;
        data.fractions[MaterialId(2)].data()[site] = 0.02f;
        mist += 0.02 * data.grid.site_volume(i, j, k);
      }
    }
  }
  const Reconstruction found(data);
  EXPECT_NEAR(found.findings().dispersed[2], mist, 1e-6);
  EXPECT_EQ(found.findings().dispersed[0] + found.findings().dispersed[1], 0);
  EXPECT_EQ(found.body_materials().size(), 2u);
  EXPECT_NEAR(found.volume_reconstructed()[MaterialId(2)], 0, 1e-15);
  EXPECT_TRUE(found.lost_bodies().empty());
  // The sphere does not change.
  const Reconstruction alone(blurred_scene("sphere", 1, 0));
  EXPECT_NEAR(found.findings().area, alone.findings().area, 1e-3 * alone.findings().area);

  const Reconstruction kept(data, {.fractions = {.keep_dispersed = true}});
  EXPECT_EQ(kept.findings().dispersed[2], 0);
  EXPECT_NEAR(kept.volume_reconstructed()[MaterialId(2)], mist, 0.01 * mist);
  EXPECT_GT(kept.body_materials().size(), 10u);
}

/// Bodies keep their own volumes, not their sum alone.
TEST(BlurredFractions, BodiesHaveTheirVolumes) {
  MultiMaterialData data;
  data.source = "two balls";
  data.grid = RectilinearGrid::uniform({40, 24, 24}, {0, 0, 0}, {1, 1, 1});
  data.materials = {"balls", "rest"};
  const std::array<std::pair<Vec3, double>, 2> balls{{{{11, 12, 12}, 7.3}, {{30, 12, 12}, 3.1}}};
  std::vector<float> f(data.grid.site_count());
  for (std::size_t site = 0; site < f.size(); ++site) {
    const Vec3 corner{static_cast<double>(site % 40), static_cast<double>(site / 40 % 24),
                      static_cast<double>(site / 960)};
    int inside = 0;
    for (int s = 0; s < 216; ++s) {
      const Vec3 p = corner + 1.0 / 6 * Vec3{s % 6 + 0.5, s / 6 % 6 + 0.5, s / 36 + 0.5};
      inside += std::ranges::any_of(balls, [&](const auto& b) { return distance(p, b.first) < b.second; });
    }
    f[site] = static_cast<float>(inside / 216.0);
  }
  std::array<double, 2> volumes{};
  for (std::size_t site = 0; site < f.size(); ++site)
    volumes[site % 40 < 21 ? 0 : 1] += static_cast<double>(f[site]);
  blur_cells(f, {40, 24, 24}, 1);
  data.fractions.resize(2);
  for (const float v : f) {
    data.fractions[MaterialId(0)].push_back(v);
    data.fractions[MaterialId(1)].push_back(1 - v);
  }
  data.normalise();
  const Reconstruction found(data);
  ASSERT_EQ(found.body_materials().size(), 3u);
  std::array<double, 3> sums{};
  for (std::size_t t = 0; t < found.bodies().size(); ++t) {
    const auto& p = found.mesh().triangles[t].points;
    const double part =
        dot(found.mesh().points[p[0]], cross(found.mesh().points[p[1]], found.mesh().points[p[2]])) / 6;
    sums[found.bodies()[t][0].value] -= part;
    sums[found.bodies()[t][1].value] += part;
  }
  std::vector<double> balls_found;
  for (BodyId b(0); b.value < 3; ++b.value) {
    if (found.body_materials()[b] == MaterialId(0)) balls_found.push_back(std::abs(sums[b.value]));
  }
  std::sort(balls_found.begin(), balls_found.end(), std::greater<>());
  ASSERT_EQ(balls_found.size(), 2u);
  EXPECT_NEAR(balls_found[0], volumes[0], 1e-3 * volumes[0]);
  EXPECT_NEAR(balls_found[1], volumes[1], 1e-3 * volumes[1]);
}

TEST(BlurredFractions, OptionsOutOfRangeAreRefused) {
  const MultiMaterialData data = blurred_scene("sphere", 0, 0, 8);
  EXPECT_THROW(Reconstruction(data, {.fractions = {.blur = -1}}), Error);
  EXPECT_THROW(Reconstruction(data, {.fractions = {.blur = 5}}), Error);
  EXPECT_THROW(Reconstruction(data, {.fractions = {.blur = std::nan("")}}), Error);
  EXPECT_THROW(Reconstruction(data, {.fractions = {.error = 0.6}}), Error);
}

}  // namespace
}  // namespace adamas
