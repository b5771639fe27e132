// Tests scenes whose fractions are blurred and noisy, by laws of the Gaussian and of the noise.

#include "datasets/fraction_blur.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "datasets/random_numbers.h"
#include "datasets/scene_sampling.h"

namespace adamas {

using namespace datasets;

namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

MultiMaterialData sample(const Scene& scene, const std::array<std::size_t, 3>& cells,
                         const FractionBlur& blur, std::uint64_t seed = 0) {
  SamplingOptions options;
  options.blur = blur, options.noise_seed = seed;
  return sample_scene(scene, cells, options);
}

double sum(const SiteArray<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// Returns a scene of two materials with a plane between them.
Scene plane_scene(const Vec3& normal, double offset) {
  SceneDescription description;
  description.name = "plane";
  description.box = {{0, 0, 0}, {1, 1, 1}};
  description.materials = IdVector<MaterialId, std::string>{"below", "above"};
  const auto zero = description.add(SceneFunction::linear({}, {}));
  const auto plane = description.add(SceneFunction::linear(normal, {}, -offset));
  description.candidates = {{MaterialId(0), {zero}}, {MaterialId(1), {plane}}};
  return Scene(std::move(description));
}

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// Returns the convolution by its definition: all weights of the three axes at once, in a box of cells of any
/// size.
std::vector<double> convolved(const std::vector<float>& values, const std::array<std::size_t, 3>& cells,
                              double blur) {
  const int reach = static_cast<int>(4 * blur + 1);
  const auto clamped = [](std::size_t i, int k, std::size_t n) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(i) + k, 0, static_cast<int>(n) - 1));
  };
  std::vector<double> result;
  for (std::size_t z = 0; z < cells[2]; ++z) {
    for (std::size_t y = 0; y < cells[1]; ++y) {
      for (std::size_t x = 0; x < cells[0]; ++x) {
        double total = 0, weights = 0;
        for (int c = -reach; c <= reach; ++c) {
          for (int b = -reach; b <= reach; ++b) {
            for (int a = -reach; a <= reach; ++a) {
              const double weight = std::exp(-(a * a + b * b + c * c) / (2 * blur * blur));
              const std::size_t at =
                  clamped(x, a, cells[0]) +
                  cells[0] * (clamped(y, b, cells[1]) + cells[1] * clamped(z, c, cells[2]));
              total += weight * static_cast<double>(values[at]), weights += weight;
            }
          }
        }
        result.push_back(total / weights);
      }
    }
  }
  return result;
}

TEST(FractionBlur, IsTheConvolutionThatItsDefinitionSays) {
  RandomNumbers random(5);
  for (const auto& cells : std::vector<std::array<std::size_t, 3>>{{7, 5, 6}, {1, 9, 2}, {3, 1, 1}}) {
    for (const double blur : {0.3, 0.8, 1.7}) {
      std::vector<float> values(cells[0] * cells[1] * cells[2]);
      for (float& value : values) value = static_cast<float>(random.uniform());
      const std::vector<double> expected = convolved(values, cells, blur);
      blur_cells(values, cells, blur);
      for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(static_cast<double>(values[i]), expected[i], 3e-7);
    }
  }
}

TEST(FractionBlur, NextToNoneChangesNothing) {
  std::vector<float> values{0.25f, 1, 0, 0.5f};
  const std::vector<float> before = values;
  for (const double blur : {0.0, 1e-300, 5e-324, 0.01}) {
    blur_cells(values, {4, 1, 1}, blur);
    EXPECT_EQ(values, before) << blur;
  }
}

// Weights add up to 1, so that what leaves a cell arrives in others: nothing is lost but at the borders.
TEST(FractionBlur, KeepsVolumesAwayFromTheBorders) {
  const Scene scene = make_scene("shell3");
  const std::array<std::size_t, 3> cells{40, 40, 40};
  const MultiMaterialData sharp = sample_scene(scene, cells);
  for (const double blur : {0.5, 1.0}) {
    const MultiMaterialData blurred = sample(scene, cells, {blur, 0});
    for (MaterialId m(0); m.value < 3; ++m.value) {
      EXPECT_NE(blurred.fractions[m], sharp.fractions[m]);
      EXPECT_NEAR(sum(blurred.fractions[m]) / sum(sharp.fractions[m]), 1, 2e-6) << blur;
    }
  }
}

TEST(FractionBlur, OfAPlaneIsANormalDistribution) {
  constexpr std::size_t kCells = 32;
  // A plane along the cells has all of them in the same phase, and the steps of their size show most.
  using Case = std::pair<Vec3, double>;
  for (const auto& [direction, tolerance] :
       {Case{{1, 0, 0}, 0.008}, Case{{1, 2, 2}, 0.001}, Case{{-3, 1, 2}, 0.001}, Case{{1, 1, 0}, 0.001}}) {
    const Vec3 normal = 1 / norm(direction) * direction;
    const double offset = dot(normal, {0.51, 0.49, 0.5});
    for (const double blur : {1.0, 1.5, 2.0}) {
      const MultiMaterialData data = sample(plane_scene(normal, offset), {kCells, kCells, kCells}, {blur, 0});
      const auto reach = static_cast<std::size_t>(4 * blur + 1);
      std::size_t mixed = 0;
      for (std::size_t k = reach; k < kCells - reach; ++k) {
        for (std::size_t j = reach; j < kCells - reach; ++j) {
          for (std::size_t i = reach; i < kCells - reach; ++i) {
            const double d = (dot(normal, data.grid.site(i, j, k)) - offset) * kCells;
            const double f = static_cast<double>(data.fraction(MaterialId(1), data.grid.site_index(i, j, k)));
            EXPECT_NEAR(f, normal_distribution(d / std::sqrt(blur * blur + 1.0 / 12)),
                        tolerance / (blur * blur));
            mixed += f > 0.01 && f < 0.99 ? 1 : 0;
          }
        }
      }
      EXPECT_GT(mixed, 1000u);
    }
  }
}

TEST(FractionBlur, LeavesNothingToNormalise) {
  for (const std::string& name : scene_names()) {
    for (const FractionBlur blur : {FractionBlur{1, 0}, FractionBlur{0, 0.02}, FractionBlur{0.7, 0.3}}) {
      MultiMaterialData data = sample(make_scene(name, 3), {9, 8, 7}, blur);
      data.check();
      const auto before = data.fractions;
      data.normalise();
      EXPECT_EQ(data.fractions, before) << name;
      EXPECT_EQ(data.report.negative + data.report.traces + data.report.renormalised, 0u) << name;
    }
  }
}

TEST(FractionBlur, FieldsFollowFromTheNewFractions) {
  const Scene scene = make_scene("voronoi10", 2);
  const MultiMaterialData data = sample(scene, {8, 7, 6}, {1, 0.01});
  ASSERT_EQ(data.fields.size(), 6u);
  for (std::size_t f = 0; f < 3; ++f) {
    for (std::size_t site = 0; site < data.grid.site_count(); ++site) {
      const Vec3 center = data.grid.site(site % 8, site / 8 % 7, site / 56);
      double mean = 0;
      for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
        const double fraction = static_cast<double>(data.fraction(m, site));
        const double value = scene.field(scene_fields()[f].first, m, center);
        EXPECT_NEAR(data.fields[f].material_values[m][site], fraction > 0 ? value : 0, 1e-5);
        mean += fraction * value;
      }
      EXPECT_NEAR(data.fields[f + 3].values[site], mean, 1e-4);
    }
  }
}

// With noises e of standard deviation s, a fraction becomes (f + e) / (1 + sum of e), to first order
// f + (1 - f) e - f (sum of the others' e).
TEST(FractionNoise, HasTheStandardDeviationThatIsAskedFor) {
  for (const double noise : {0.005, 0.02}) {
    for (const std::vector<double>& fractions :
         {std::vector<double>{0.5, 0.5}, {0.2, 0.8}, {0.3, 0.3, 0.4}, {0.25, 0.35, 0, 0.4}}) {
      constexpr std::size_t kTrials = 40000;
      const auto noisy_ones =
          static_cast<double>(fractions.size() - std::count(fractions.begin(), fractions.end(), 0.0));
      std::vector<double> sums(fractions.size()), squares(fractions.size());
      for (std::size_t cell = 0; cell < kTrials; ++cell) {
        std::vector<double> noisy = fractions;
        add_noise(noisy, noise, 1, cell);
        double total = 0;
        for (std::size_t m = 0; m < noisy.size(); ++m) {
          sums[m] += noisy[m] - fractions[m];
          squares[m] += (noisy[m] - fractions[m]) * (noisy[m] - fractions[m]);
          total += noisy[m];
        }
        ASSERT_NEAR(total, 1, 1e-15);
      }
      for (std::size_t m = 0; m < fractions.size(); ++m) {
        const double f = fractions[m];
        const double expected = f == 0 ? 0 : noise * std::sqrt((1 - f) * (1 - f) + (noisy_ones - 1) * f * f);
        EXPECT_NEAR(std::sqrt(squares[m] / kTrials), expected, 0.02 * expected);
        // The mean is of the second order in the noise, apart from the statistical error.
        EXPECT_NEAR(sums[m] / kTrials, 0, 4 * expected / std::sqrt(kTrials) + noise * noise);
      }
    }
  }
}

TEST(FractionNoise, IsInMixedCellsOnly) {
  const Scene scene = make_scene("sphere");
  const MultiMaterialData sharp = sample_scene(scene, {16, 16, 16}),
                          noisy = sample(scene, {16, 16, 16}, {0, 0.02});
  std::size_t changed = 0;
  for (std::size_t site = 0; site < sharp.grid.site_count(); ++site) {
    const float before = sharp.fraction(MaterialId(0), site), after = noisy.fraction(MaterialId(0), site);
    if (before > 2e-4f && before < 1 - 2e-4f) changed += after != before ? 1 : 0;
    if (before == 0 || before == 1) {
      EXPECT_EQ(after, before);
    }
    EXPECT_NEAR(static_cast<double>(after), static_cast<double>(before), 0.1);
  }
  EXPECT_GT(changed, 500u);
}

// There is so much noise that some cells lose all that they have: these stay as they were.
TEST(FractionNoise, LeavesSomethingInEachCell) {
  std::size_t kept = 0;
  for (std::size_t cell = 0; cell < 1000; ++cell) {
    std::vector<double> fractions{0.5, 0.5};
    add_noise(fractions, 1, 3, cell);
    EXPECT_NEAR(fractions[0] + fractions[1], 1, 1e-15);
    EXPECT_GE(std::min(fractions[0], fractions[1]), 0);
    kept += fractions[0] == 0.5 ? 1 : 0;
  }
  // Fractions stay where both fall below 0, which has a probability of 0.0952; both rise above 1 as often.
  EXPECT_NEAR(static_cast<double>(kept), 190, 50);
}

TEST(FractionNoise, FollowsFromTheSeedAndTheCell) {
  const Scene scene = make_scene("reflex");
  const std::array<std::size_t, 3> cells{10, 10, 10};
  const auto fractions = [&](std::uint64_t seed) { return sample(scene, cells, {1, 0.02}, seed).fractions; };
  EXPECT_EQ(fractions(1), fractions(1));
  EXPECT_NE(fractions(1), fractions(2));
  std::vector<double> one{0.4, 0.6}, other = one;
  add_noise(one, 0.02, 1, 7), add_noise(other, 0.02, 1, 8);
  EXPECT_NE(one, other);
}

TEST(FractionBlur, TheSameOnAnyNumberOfThreads) {
  const Scene scene = make_scene("random", 12);
  const std::array<std::size_t, 3> cells{21, 20, 19};
  set_thread_limit(1);
  const MultiMaterialData one = sample(scene, cells, {1.3, 0.02}, 4);
  set_thread_limit(2);
  const MultiMaterialData two = sample(scene, cells, {1.3, 0.02}, 4);
  set_thread_limit(0);
  EXPECT_EQ(one.fractions, two.fractions);
  for (std::size_t f = 0; f < one.fields.size(); ++f) {
    EXPECT_EQ(one.fields[f].values, two.fields[f].values);
    EXPECT_EQ(one.fields[f].material_values, two.fields[f].material_values);
  }
}

TEST(FractionBlur, OfTheLibraryIsTheSameAndTellsTheTruth) {
  const GeneratedScene sharp = generate_scene("voronoi10", {8, 8, 8}, 3);
  const GeneratedScene blurred = generate_scene("voronoi10", {8, 8, 8}, FractionBlur{1, 0.02}, 3);
  for (std::size_t m = 0; m < sharp.materials.size(); ++m)
    EXPECT_EQ(blurred.materials[m].volume, sharp.materials[m].volume);
  const MultiMaterialData expected = sample(make_scene("voronoi10", 3), {8, 8, 8}, {1, 0.02}, 3);
  const GridData data = blurred.data.view();
  for (MaterialId m(0); m.value < data.fractions.size(); ++m.value) {
    const auto values = std::get<std::span<const float>>(data.fractions[m.value]);
    EXPECT_TRUE(std::ranges::equal(values, expected.fractions[m]));
  }
}

TEST(FractionBlur, ValuesOutOfRangeAreRefused) {
  const Scene scene = make_scene("sphere");
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double value : {-1e-9, 16.01, kNoNumber, infinite, -infinite, 1e300}) {
    EXPECT_THROW(sample(scene, {4, 4, 4}, {value, 0}), Error) << value;
    EXPECT_THROW(sample(scene, {4, 4, 4}, {0, value}), Error) << value;
    EXPECT_THROW(generate_scene("sphere", {4, 4, 4}, FractionBlur{value, 0}), Error) << value;
  }
  EXPECT_THROW(sample(scene, {4, 4, 4}, {0, 1.01}), Error);
  EXPECT_NO_THROW(sample(scene, {4, 4, 4}, {16, 1}));
}

}  // namespace
}  // namespace adamas
