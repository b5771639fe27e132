#include "datasets/scene_sampling.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "datasets/random_numbers.h"
#include "datasets/scene_integral.h"

namespace adamas {

using namespace datasets;

namespace {

struct Sampled {
  MultiMaterialData data;
  SceneIntegral integral;
};

Sampled sample(const Scene& scene, std::size_t n, int depth = 3) {
  Sampled result;
  result.data = sample_scene(scene, {n, n, n}, {depth, true}, SilentProgress::instance(), &result.integral);
  return result;
}

Box3 cell_of(const RectilinearGrid& grid, std::size_t i, std::size_t j, std::size_t k) {
  return {{grid.nodes[0][i], grid.nodes[1][j], grid.nodes[2][k]},
          {grid.nodes[0][i + 1], grid.nodes[1][j + 1], grid.nodes[2][k + 1]}};
}

template <class Visit>
void for_each_cell(const RectilinearGrid& grid, Visit&& visit) {
  for (std::size_t k = 0; k < grid.sites(2); ++k) {
    for (std::size_t j = 0; j < grid.sites(1); ++j) {
      for (std::size_t i = 0; i < grid.sites(0); ++i) visit(grid.site_index(i, j, k), cell_of(grid, i, j, k));
    }
  }
}

TEST(PositiveFraction, AgreesWithCountedPointsAndComplements) {
  RandomNumbers random(1);
  for (int trial = 0; trial < 60; ++trial) {
    std::array<double, 4> v, opposite;
    for (std::size_t i = 0; i < 4; ++i) {
      v[i] = random.uniform(-1, 1);
      opposite[i] = -v[i];
    }
    int positive = 0;
    constexpr int kPoints = 20000;
    for (int p = 0; p < kPoints; ++p) {
      std::array<double, 4> w;
      double sum = 0, value = 0;
      for (double& x : w) sum += x = -std::log(1 - random.uniform());
      for (std::size_t i = 0; i < 4; ++i) value += w[i] / sum * v[i];
      positive += value > 0 ? 1 : 0;
    }
    EXPECT_NEAR(positive_fraction(v), static_cast<double>(positive) / kPoints, 0.02);
    EXPECT_NEAR(positive_fraction(v) + positive_fraction(opposite), 1, 1e-14);
  }
  EXPECT_EQ(positive_fraction({0, 0, 0, 0}), 0);
  EXPECT_EQ(positive_fraction({1, 0, 0, 0}), 1);
  EXPECT_EQ(positive_fraction({0, 0, 0, -1}), 0);
}

TEST(SceneSampling, FractionsAgreeWithCountedPoints) {
  std::vector<Scene> scenes;
  for (const std::string& name : scene_names()) scenes.push_back(make_scene(name, 1));
  for (std::uint64_t seed = 20; seed < 24; ++seed) scenes.push_back(make_scene("random", seed));
  for (const Scene& scene : scenes) {
    const Sampled s = sample(scene, 6, 3);
    RandomNumbers random(2);
    for_each_cell(s.data.grid, [&](std::size_t site, const Box3& box) {
      constexpr int kPoints = 1000;
      std::vector<int> hits(scene.materials().size());
      for (int p = 0; p < kPoints; ++p) ++hits[scene.owner(random.point(box)).value];
      for (MaterialId m(0); m.value < hits.size(); ++m.value) {
        const double f = static_cast<double>(s.data.fractions[m][site]);
        const double deviation = std::sqrt(f * (1 - f) / kPoints);
        EXPECT_NEAR(hits[m.value] / static_cast<double>(kPoints), f, 5 * deviation + 0.004) << scene.name();
      }
    });
  }
}

TEST(SceneSampling, FractionsAddUpAndPassTheCheck) {
  for (const std::string& name : scene_names()) {
    const Scene scene = make_scene(name, 4);
    const Sampled s = sample(scene, 10, 2);
    s.data.check();
    for (std::size_t site = 0; site < s.data.grid.site_count(); ++site) {
      double sum = 0;
      for (const auto& fractions : s.data.fractions) {
        EXPECT_GE(fractions[site], 0.0f);
        EXPECT_LE(fractions[site], 1.0f);
        sum += static_cast<double>(fractions[site]);
      }
      EXPECT_NEAR(sum, 1, 3e-7) << name;
    }
  }
}

TEST(SceneSampling, PureCellsHaveOneOwner) {
  for (const std::string& name : scene_names()) {
    const Scene scene = make_scene(name, 6);
    const Sampled s = sample(scene, 9, 2);
    RandomNumbers random(3);
    std::size_t pure = 0;
    for_each_cell(s.data.grid, [&](std::size_t site, const Box3& box) {
      for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
        if (s.data.fractions[m][site] < 1.0f) continue;
        ++pure;
        for (int p = 0; p < 20; ++p) EXPECT_EQ(scene.owner(random.point(box)), m) << name;
      }
    });
    EXPECT_GT(pure, 0u) << name;
  }
}

TEST(SceneSampling, PlanarVolumesAreExact) {
  for (const std::string name : {"plate", "tjunction", "reflex", "voronoi10"}) {
    const Scene scene = make_scene(name, 7);
    ASSERT_TRUE(scene.planar());
    SceneIntegral integral;
    sample_scene(scene, {7, 9, 8}, {}, SilentProgress::instance(), &integral);
    for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
      EXPECT_NEAR(integral.volumes[m], scene.volume(m), 1e-12) << name;
      EXPECT_LT(integral.errors[m], 1e-12) << name;
    }
  }
}

TEST(SceneSampling, CurvedVolumesConvergeWithinTheirStatedError) {
  for (const std::string name : {"sphere", "shell2", "shell3"}) {
    const Scene scene = make_scene(name);
    for (const int depth : {1, 2, 3}) {
      const Sampled s = sample(scene, 8, depth);
      for (MaterialId m(0); m.value < scene.materials().size(); ++m.value) {
        const double error = std::abs(s.integral.volumes[m] - scene.volume(m));
        EXPECT_LE(error, s.integral.errors[m] + 1e-12) << name << " depth " << depth;
      }
    }
  }
}

TEST(LongSceneSampling, SphereOn64Cubed) {
  const Scene scene = make_scene("sphere");
  const Sampled s = sample(scene, 64);
  for (MaterialId m(0); m.value < 2; ++m.value) {
    EXPECT_NEAR(s.integral.volumes[m] / scene.volume(m), 1, 1e-4);
    double total = 0;
    for (const float f : s.data.fractions[m]) total += static_cast<double>(f);
    EXPECT_NEAR(total / (64.0 * 64 * 64) / scene.volume(m), 1, 1e-4);
  }
}

TEST(SceneSampling, FieldsAreThoseOfTheScene) {
  const Scene scene = make_scene("shell3");
  const Sampled s = sample(scene, 12, 1);
  const RectilinearGrid& grid = s.data.grid;
  ASSERT_EQ(s.data.fields.size(), 6u);
  for (std::size_t f = 0; f < 3; ++f) {
    const Field &own = s.data.fields[f], &mixed = s.data.fields[f + 3];
    EXPECT_EQ(own.name, scene_fields()[f].second);
    EXPECT_EQ(mixed.name, "mixed " + own.name);
    EXPECT_TRUE(own.per_material());
    EXPECT_FALSE(mixed.per_material());
    for_each_cell(grid, [&](std::size_t site, const Box3& box) {
      double sum = 0;
      for (MaterialId m(0); m.value < 3; ++m.value) {
        const float fraction = s.data.fractions[m][site];
        const double value = scene.field(scene_fields()[f].first, m, box.center());
        const double expected = fraction > 0 ? value : 0;
        EXPECT_NEAR(own.material_values[m][site], expected, 1e-5);
        sum += static_cast<double>(fraction) * value;
      }
      EXPECT_NEAR(mixed.values[site], sum, 1e-4);
    });
  }
}

TEST(SceneSampling, TheSameOnAnyNumberOfThreads) {
  const Scene scene = make_scene("random", 12);
  set_thread_limit(1);
  const Sampled one = sample(scene, 12, 2);
  set_thread_limit(2);
  const Sampled two = sample(scene, 12, 2);
  set_thread_limit(0);
  EXPECT_EQ(one.data.fractions, two.data.fractions);
  EXPECT_EQ(one.integral.volumes, two.integral.volumes);
  EXPECT_EQ(one.integral.errors, two.integral.errors);
  for (std::size_t f = 0; f < one.data.fields.size(); ++f) {
    EXPECT_EQ(one.data.fields[f].values, two.data.fields[f].values);
    EXPECT_EQ(one.data.fields[f].material_values, two.data.fields[f].material_values);
  }
}

TEST(SceneSampling, NothingIsLeftToNormalise) {
  for (const std::string& name : scene_names()) {
    MultiMaterialData data = sample_scene(make_scene(name, 3), {9, 8, 7});
    const auto before = data.fractions;
    data.normalise();
    EXPECT_EQ(data.fractions, before) << name;
    EXPECT_EQ(data.report.negative + data.report.traces + data.report.renormalised, 0u) << name;
  }
}

TEST(SceneSampling, BadRequestsAreRefused) {
  const Scene scene = make_scene("sphere");
  EXPECT_THROW(sample_scene(scene, {0, 4, 4}), Error);
  EXPECT_THROW(sample_scene(scene, {4, 4, 4}, {0, true}), Error);
  EXPECT_THROW(sample_scene(scene, {4, 4, 4}, {9, true}), Error);
  EXPECT_THROW(sample_scene(scene, {1000000, 1000000, 1000000}), Error);
  const std::size_t huge = ~std::size_t{0};
  EXPECT_THROW(sample_scene(scene, {huge, huge, huge}), Error);
}

TEST(SceneSampling, CanBeCancelled) {
  class Stop final : public Progress {
   public:
    void report(std::string_view, double) override {}
    [[nodiscard]] bool cancelled() const override { return true; }
  } stop;
  EXPECT_THROW(sample_scene(make_scene("sphere"), {8, 8, 8}, {}, stop), Cancelled);
}

}  // namespace
}  // namespace adamas
