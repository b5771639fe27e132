// Tests gradients of a series that are smoothed in space and along time: smoothing strips of rows while
// planes come one by one gives the same as smoothing whole arrays.

#include "timevarying/series_gradients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <random>

#include "adamas/geometry.h"
#include "core/base/parallel.h"
#include "isosurface/gradients/gradient_pages.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "isosurface/gradients/plane_gradients.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/storage/store_options.h"
#include "isosurface/storage/stored_pages.h"
#include "tests/support/scratch.h"
#include "timevarying/series_builder.h"
#include "timevarying/series_smoothing.h"

namespace adamas {

using namespace isosurface;
using namespace timevarying;

namespace {

using Codes = std::vector<OctahedralCode>;
using Gradients = std::vector<Gradient>;
using Sizes = std::array<std::uint64_t, 3>;

/// The steps of a series in memory.
struct Series {
  VolumeGrid grid;
  std::vector<std::vector<float>> steps;

  /// Samples fn(i, j, k, step).
  template <class Fn>
  Series(const Sizes& dimensions, std::size_t count, Fn&& fn) {
    grid.dimensions = dimensions;
    grid.type = SampleType::kFloat32;
    grid.spacing = {1, 1.5, 0.75};
    for (std::size_t t = 0; t < count; ++t) {
      std::vector<float>& step = steps.emplace_back();
      for (std::uint64_t n = 0; n < grid.samples(); ++n)
        step.push_back(static_cast<float>(fn(static_cast<double>(n % dimensions[0]),
                                             static_cast<double>(n / dimensions[0] % dimensions[1]),
                                             static_cast<double>(n / grid.plane_samples()), t)));
    }
  }

  [[nodiscard]] PlaneSource planes(std::size_t t) const {
    return [this, t](std::uint64_t k, std::span<std::byte> to) {
      std::memcpy(to.data(), steps[t].data() + k * grid.plane_samples(), to.size());
    };
  }
  [[nodiscard]] std::vector<RowSource> rows() const {
    std::vector<RowSource> all;
    for (const std::vector<float>& step : steps) {
      all.emplace_back([this, &step](std::uint64_t k, std::uint64_t row, std::span<std::byte> to) {
        std::memcpy(to.data(), step.data() + k * grid.plane_samples() + row * grid.dimensions[0], to.size());
      });
    }
    return all;
  }
  [[nodiscard]] Gradients gradients(std::size_t t) const {
    const std::uint64_t plane = grid.plane_samples();
    const PlaneGradients estimate(grid.spacing, grid.dimensions[0], grid.dimensions[1]);
    Gradients all(grid.samples());
    const auto at = [&](std::uint64_t k) {
      return k < grid.dimensions[2] ? steps[t].data() + k * plane : nullptr;
    };
    for (std::uint64_t k = 0; k < grid.dimensions[2]; ++k)
      estimate(std::array<const float*, 3>{at(k - 1), at(k), at(k + 1)},
               std::span(all).subspan(k * plane, plane));
    return all;
  }
  /// Returns the codes of all steps after smoothing in strips, step after step.
  [[nodiscard]] Codes in_strips(const GradientPageOptions& options) const {
    ScratchFile file(options.scratch);
    series_codes<float>(grid, rows(), options, file, SilentProgress::instance());
    Codes all(grid.samples() * steps.size());
    file.read(0, std::as_writable_bytes(std::span(all)));
    return all;
  }
};

/// Returns a ball that moves in noise. A part of it never changes, and some steps are constant.
Series moving(const Sizes& dimensions, std::size_t count, double noise = 3, double speed = 1) {
  std::mt19937 random(static_cast<unsigned>(dimensions[0] + 20 * dimensions[1] + 400 * dimensions[2]));
  return {dimensions, count, [&, noise, speed](double i, double j, double k, std::size_t t) {
            const double r = std::hypot(i - 6 - speed * static_cast<double>(t), j - 9, k - 7);
            const double error = noise * static_cast<double>(random() >> 8) / (1 << 24);
            return t % 5 == 4 ? 7 : r > 12 ? 20 : 5 * r + error;
          }};
}

/// Smooths whole arrays step by step as the definition says. Floats are added in the same order as in the
/// program.
class WholeArrays {
 public:
  WholeArrays(const Series& series, const GradientSmoothingOptions& options)
      : sizes_(series.grid.dimensions), options_(options) {
    for (std::size_t t = 0; t < series.steps.size(); ++t) {
      now_.push_back(series.gradients(t));
      scales_.emplace_back().add(now_.back());
    }
  }

  [[nodiscard]] Codes smoothed() {
    const std::vector<Gradients> original = now_;
    for (std::size_t round = 0; round < options_.rounds(); ++round) {
      const bool is_held = round >= static_cast<std::size_t>(options_.free_rounds);
      if (round == static_cast<std::size_t>(options_.free_rounds)) hold(original);
      for (std::size_t t = 0; t < now_.size(); ++t) smooth_in_space(t, is_held);
      if (round + 1 == options_.rounds_before_time() || round + 1 == options_.rounds()) smooth_along_time();
    }
    Codes all;
    for (const Gradients& step : now_) {
      Codes codes(step.size());
      encode_octahedral(step, codes);
      all.insert(all.end(), codes.begin(), codes.end());
    }
    return all;
  }

 private:
  [[nodiscard]] bool is_degenerate(std::size_t t, const Gradient& g) const {
    return squared_length(g) <= scales_[t].least_square();
  }
  void hold(const std::vector<Gradients>& original) {
    anchors_ = now_;
    for (std::size_t t = 0; t < now_.size(); ++t)
      for (std::size_t at = 0; at < now_[t].size(); ++at)
        if (is_degenerate(t, original[t][at])) anchors_[t][at] = {};
  }
  [[nodiscard]] Gradient held(std::size_t t, std::size_t at, const Gradient& average) const {
    const Gradient& anchor = anchors_[t][at];
    if (squared_length(anchor) == 0) return average;
    return constrained(anchor, average, options_.freedom * scales_[t].mean_square());
  }

  /// Adds neighbours with weights 1, 2, 1 along one axis.
  void add_along(std::vector<std::array<float, 4>>& sums, std::size_t axis) const {
    const std::size_t stride = axis == 0 ? 1 : axis == 1 ? sizes_[0] : sizes_[0] * sizes_[1];
    const std::vector<std::array<float, 4>> from = sums;
    for (std::size_t at = 0; at < sums.size(); ++at) {
      const std::size_t place = at / stride % sizes_[axis];
      for (std::size_t n = 0; n < 4; ++n) {
        const float below = place > 0 ? from[at - stride][n] : 0;
        const float above = place + 1 < sizes_[axis] ? from[at + stride][n] : 0;
        sums[at][n] = (below + above) + 2 * from[at][n];
      }
    }
  }
  void smooth_in_space(std::size_t t, bool is_held) {
    std::vector<std::array<float, 4>> sums;
    for (const Gradient& g : now_[t])
      sums.push_back(is_degenerate(t, g) ? std::array<float, 4>{}
                                         : std::array<float, 4>{g[0], g[1], g[2], 1});
    for (const std::size_t axis : {0, 1, 2}) add_along(sums, axis);
    for (std::size_t at = 0; at < sums.size(); ++at) {
      const auto [x, y, z, weight] = sums[at];
      if (weight == 0) continue;
      const Gradient average{x / weight, y / weight, z / weight};
      if (!is_degenerate(t, average)) now_[t][at] = is_held ? held(t, at, average) : average;
    }
  }

  void smooth_along_time() {
    const std::size_t count = now_.size();
    for (std::size_t at = 0; at < now_[0].size(); ++at) {
      Gradients line;
      for (std::size_t t = 0; t < count; ++t) line.push_back(seed(t, at));
      for (int round = 0; round < options_.time_rounds; ++round) {
        const Gradients before = line;
        for (std::size_t t = 0; t < count; ++t) {
          const Gradient &a = before[t - std::min<std::size_t>(t, 1)], &b = before[t],
                         &c = before[std::min(t + 1, count - 1)];
          Gradient average{};
          for (std::size_t n = 0; n < 3; ++n) average[n] = ((a[n] + c[n]) + 2 * b[n]) / 4;
          if (average != b && !is_degenerate(t, average)) line[t] = held(t, at, average);
        }
      }
      for (std::size_t t = 0; t < count; ++t) now_[t][at] = line[t];
    }
  }
  /// Returns the step's own gradient where it has one, else that of the nearest step before, else that of the
  /// nearest step behind.
  [[nodiscard]] Gradient seed(std::size_t t, std::size_t at) const {
    for (std::size_t s = t + 1; s-- > 0;)
      if (!is_degenerate(s, now_[s][at])) return now_[s][at];
    for (std::size_t s = t; s < now_.size(); ++s)
      if (!is_degenerate(s, now_[s][at])) return now_[s][at];
    return now_[t][at];
  }

  Sizes sizes_;
  GradientSmoothingOptions options_;
  std::vector<GradientScale> scales_;
  std::vector<Gradients> now_, anchors_;
};

TEST(SeriesGradients, StripsAreTheWholeArrays) {
  const std::vector<GradientSmoothingOptions> ways = {
      {}, {0, 1, 0.25, 1}, {2, 1, 0.25, 3}, {0, 3, 0.1, 2}, {1, 2, 0, 1}, {1, 5, 4, 7}};
  for (const Sizes& sizes : {Sizes{1, 1, 1}, {5, 1, 3}, {9, 50, 5}, {3, 70, 12}}) {
    for (const std::size_t count : {2, 5}) {
      const Series series = moving(sizes, count);
      for (const GradientSmoothingOptions& way : ways) {
        GradientPageOptions options;
        options.smoothing = way;
        const Codes whole = WholeArrays(series, way).smoothed();
        ASSERT_EQ(series.in_strips(options), whole);
        // Strips have the fewest rows that are possible, and some more.
        const std::size_t row = (SmoothingRounds::bytes(way) + 12) * sizes[0] * count;
        for (const std::size_t rows : {std::size_t{0}, 3 * way.rounds() + 8}) {
          options.memory = rows * row;
          ASSERT_EQ(series.in_strips(options), whole) << sizes[1] << " rows, " << rows << " at a time";
        }
      }
    }
  }
}

TEST(SeriesGradients, AreTheSameOnAnyNumberOfThreads) {
  const Series series = moving({70, 80, 12}, 6);
  std::vector<Codes> found;
  for (const unsigned threads : {1u, 2u, 5u}) {
    set_thread_limit(threads);
    found.push_back(series.in_strips({}));
  }
  set_thread_limit(0);
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
}

/// Where nothing changes along time the codes are those of smoothing in space alone, bit for bit.
TEST(SeriesGradients, WhatStaysIsSmoothedInSpace) {
  const Series one = moving({30, 25, 20}, 1);
  Series series = one;
  for (int t = 0; t < 6; ++t) series.steps.push_back(one.steps[0]);
  Codes alone;
  smoothed_codes<float>(
      one.grid, one.planes(0), {},
      [&alone](const Codes& plane) { alone.insert(alone.end(), plane.begin(), plane.end()); },
      SilentProgress::instance());
  const Codes found = series.in_strips({});
  ASSERT_EQ(found.size(), 7 * alone.size());
  for (std::size_t n = 0; n < found.size(); ++n) ASSERT_EQ(found[n], alone[n % alone.size()]) << n;
}

TEST(SeriesGradients, NothingStaysWhereAnyStepHasAGradient) {
  // Only the second step has samples that change.
  const Series series({8, 8, 8}, 4,
                      [](double i, double j, double, std::size_t t) { return t == 1 ? i + j : 3; });
  for (const OctahedralCode& code : series.in_strips({})) {
    const Vec3 direction = decode_octahedral({code[0], code[1]});
    ASSERT_GT(direction.x, 0.7);
    ASSERT_GT(direction.y, 0.4);
  }
  const Series empty({8, 8, 8}, 4, [](double, double, double, std::size_t t) { return t; });
  for (const OctahedralCode& code : empty.in_strips({}))
    ASSERT_EQ(norm(decode_octahedral({code[0], code[1]})), 0);
}

/// Mean angles of stored directions, in degrees, where steps have a gradient: between those of neighbouring
/// steps at the same place, and between each and the true one.
struct Angles {
  double along_time = 0, from_true = 0;
};
template <class True>
Angles angles_of(const Series& series, const StoreOptions& how, const True& true_direction) {
  const test::Scratch folder;
  StoreOptions options = how;
  options.gradients = true;
  options.scratch = folder / "";
  std::vector<double> times;
  for (std::size_t t = 0; t < series.steps.size(); ++t) times.push_back(static_cast<double>(t));
  build_series(folder / "s.adm", "s.adm",
               {series.grid, times, [&](std::uint32_t t) { return series.planes(t); }}, options);
  StoreFile file(folder / "s.adm");
  const auto angle = [](const Vec3& a, const Vec3& b) {
    return std::acos(std::clamp(dot(a, b) / (norm(a) * norm(b)), -1.0, 1.0)) * 180 / M_PI;
  };
  Angles sum;
  std::size_t pairs = 0, all = 0;
  std::unique_ptr<StoredGradients> before;
  for (std::uint32_t t = 0; t < file.steps(); ++t) {
    auto here = std::make_unique<StoredGradients>(file, t, std::size_t{1} << 26);
    for (std::uint64_t n = 0; n < series.grid.samples(); ++n) {
      const auto [nx, ny, nz] = series.grid.dimensions;
      const LatticePoint p{static_cast<std::int32_t>(n % nx), static_cast<std::int32_t>(n / nx % ny),
                           static_cast<std::int32_t>(n / (nx * ny))};
      const Vec3 expected = true_direction(p, t);
      const std::optional<Vec3> found = here->direction(p);
      if (norm(expected) == 0 || !found || norm(*found) == 0) continue;
      sum.from_true += angle(*found, expected);
      ++all;
      if (before == nullptr || norm(true_direction(p, t - 1)) == 0) continue;
      sum.along_time += angle(*found, *before->direction(p));
      ++pairs;
    }
    before = std::move(here);
  }
  EXPECT_GT(pairs, 4000u);
  return {sum.along_time / static_cast<double>(pairs), sum.from_true / static_cast<double>(all)};
}

TEST(SeriesGradients, AreMoreCoherentAndNearerToTheTrueOnesInNoise) {
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, 6);
  const auto centre = [](double t) { return Vec3{12 + 0.4 * t, 13, 11.5}; };
  Series series({26, 26, 24}, 12, [&](double i, double j, double k, std::size_t t) {
    return 10 * norm(Vec3{i, j, k} - centre(static_cast<double>(t))) + noise(random);
  });
  series.grid.spacing = {1, 1, 1};
  const auto true_direction = [&](LatticePoint p, std::uint32_t t) {
    const Vec3 out = Vec3{double(p.i), double(p.j), double(p.k)} - centre(t);
    return norm(out) > 4 ? out : Vec3{};
  };
  StoreOptions in_space;
  in_space.smoothing->time_rounds = 0;
  const Angles space = angles_of(series, in_space, true_direction);
  const Angles time = angles_of(series, {}, true_direction);
  EXPECT_GT(space.along_time, 1);
  EXPECT_LT(time.along_time, 0.8 * space.along_time);
  EXPECT_LT(time.from_true, space.from_true);
}

/// Smoothing uses no steps of other blocks.
TEST(SeriesGradients, BlocksAreSmoothedByThemselves) {
  const Series series = moving({20, 18, 17}, 7);
  const test::Scratch folder;
  StoreOptions options;
  options.gradients = true;
  options.scratch = folder / "";
  options.block_steps = 4;
  const auto planes = [&](std::uint32_t t) { return series.planes(t); };
  build_series(folder / "a.adm", "a.adm", {series.grid, {0, 1, 2, 3, 4, 5, 6}, planes}, options);
  build_series(folder / "b.adm", "b.adm", {series.grid, {0, 1, 2, 3}, planes}, options);
  append_series(StoreLock(folder / "b.adm"),
                {series.grid, {4, 5, 6}, [&](std::uint32_t t) { return series.planes(t + 4); }}, options);
  StoreFile a(folder / "a.adm"), b(folder / "b.adm");
  for (std::uint32_t t = 0; t < 7; ++t) {
    StoredGradients of_a(a, t, std::size_t{1} << 26), of_b(b, t, std::size_t{1} << 26);
    for (std::int32_t n = 0; n < 20 * 18 * 17; ++n) {
      const LatticePoint p{n % 20, n / 20 % 18, n / 360};
      ASSERT_EQ(norm(*of_a.direction(p) - *of_b.direction(p)), 0) << t;
    }
  }
}

}  // namespace
}  // namespace adamas
