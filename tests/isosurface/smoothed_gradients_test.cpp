// Tests the smoothed gradients of stores: smoothing strips of rows while planes come one by one gives the
// same as smoothing the whole volume.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "core/base/parallel.h"
#include "isosurface/gradients/gradient_pages.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "isosurface/gradients/plane_gradients.h"
#include "isosurface/storage/store_file.h"
#include "isosurface/storage/store_options.h"
#include "isosurface/storage/stored_pages.h"
#include "tests/support/build_store.h"
#include "tests/support/scratch.h"
#include "tests/support/smoothed_block.h"

namespace adamas {

using namespace isosurface;

namespace {

/// A volume in memory that counts how often each of its planes was asked for.
struct Volume {
  VolumeGrid grid;
  std::vector<float> samples;

  template <class Fn>
  Volume(const std::array<std::uint64_t, 3>& dimensions, const Vec3& spacing, Fn&& fn) {
    grid.dimensions = dimensions;
    grid.type = SampleType::kFloat32;
    grid.spacing = spacing;
    for (std::uint64_t k = 0; k < dimensions[2]; ++k)
      for (std::uint64_t j = 0; j < dimensions[1]; ++j)
        for (std::uint64_t i = 0; i < dimensions[0]; ++i)
          samples.push_back(
              static_cast<float>(fn(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k))));
  }

  [[nodiscard]] PlaneSource planes() const {
    return [this](std::uint64_t k, std::span<std::byte> to) {
      std::memcpy(to.data(), samples.data() + k * grid.plane_samples(), to.size());
    };
  }
  [[nodiscard]] std::vector<Gradient> gradients() const {
    const std::uint64_t nx = grid.dimensions[0], ny = grid.dimensions[1], nz = grid.dimensions[2];
    const PlaneGradients estimate(grid.spacing, nx, ny);
    std::vector<Gradient> gradients(grid.samples());
    const auto plane = [&](std::uint64_t k) { return k < nz ? samples.data() + k * nx * ny : nullptr; };
    for (std::uint64_t k = 0; k < nz; ++k) {
      estimate(std::array<const float*, 3>{plane(k - 1), plane(k), plane(k + 1)},
               std::span(gradients).subspan(k * nx * ny, nx * ny));
    }
    return gradients;
  }
  /// Returns the codes after smoothing the whole volume at once.
  [[nodiscard]] std::vector<OctahedralCode> smoothed(const GradientSmoothingOptions& options = {}) const {
    std::vector<Gradient> all = gradients();
    test::smooth_gradients(all, {grid.dimensions[0], grid.dimensions[1], grid.dimensions[2]}, options);
    std::vector<OctahedralCode> codes(all.size());
    encode_octahedral(all, codes);
    return codes;
  }
  /// Returns the codes after smoothing strips while the planes come one by one.
  [[nodiscard]] std::vector<OctahedralCode> in_strips(const GradientPageOptions& options) const {
    std::vector<OctahedralCode> codes;
    smoothed_codes<float>(
        grid, planes(), options,
        [&codes](const std::vector<OctahedralCode>& plane) {
          codes.insert(codes.end(), plane.begin(), plane.end());
        },
        SilentProgress::instance());
    return codes;
  }
};

/// Returns waves and noise, with a part where nothing changes.
Volume rough(const std::array<std::uint64_t, 3>& dimensions) {
  std::mt19937 random(static_cast<unsigned>(dimensions[0] + 20 * dimensions[1] + 400 * dimensions[2]));
  return {dimensions, {1, 1.5, 0.75}, [&](double i, double j, double k) {
            const double noise = static_cast<double>(random() >> 28);
            return i + j + k < 22 ? 50 : 60 + 40 * std::sin(0.3 * i) * std::cos(0.2 * j + 0.1 * k) + noise;
          }};
}

TEST(SmoothedGradients, StripsAreTheWholeVolume) {
  const std::vector<GradientSmoothingOptions> ways = {
      {}, {0, 0, 0.25}, {2, 0, 0.25}, {0, 3, 0.1}, {1, 2, 0.25}};
  for (const std::array<std::uint64_t, 3>& dimensions : std::vector<std::array<std::uint64_t, 3>>{
           {1, 1, 1}, {5, 1, 3}, {9, 50, 5}, {33, 25, 1}, {20, 37, 30}, {3, 90, 14}}) {
    const Volume volume = rough(dimensions);
    for (const GradientSmoothingOptions& way : ways) {
      const std::vector<OctahedralCode> whole = volume.smoothed(way);
      GradientPageOptions options;
      options.smoothing = way;
      ASSERT_EQ(volume.in_strips(options), whole);
      // Strips have the fewest rows that are possible, and some more.
      const std::size_t row = SmoothingRounds::bytes(way) * dimensions[0];
      for (const std::size_t rows : {std::size_t{0}, 3 * way.rounds() + 1, 3 * way.rounds() + 8}) {
        options.memory = rows * row;
        ASSERT_EQ(volume.in_strips(options), whole) << dimensions[1] << " rows, " << rows << " at a time";
      }
    }
  }
}

TEST(SmoothedGradients, AreTheSameOnAnyNumberOfThreads) {
  const Volume volume = rough({120, 160, 20});
  GradientPageOptions options;
  options.memory = std::size_t{60} * 120 * SmoothingRounds::bytes({});
  std::vector<std::vector<OctahedralCode>> found;
  for (const unsigned threads : {1u, 2u, 5u}) {
    set_thread_limit(threads);
    found.push_back(volume.in_strips(options));
  }
  set_thread_limit(0);
  EXPECT_EQ(found[0], found[1]);
  EXPECT_EQ(found[0], found[2]);
  EXPECT_EQ(found[0], volume.smoothed());
}

TEST(SmoothedGradients, PlanesComeOnceForTheScaleAndOnceForEachStrip) {
  const Volume volume = rough({9, 100, 11});
  for (const std::size_t rows : {100, 62, 50}) {
    GradientPageOptions options;
    options.memory = rows * 9 * SmoothingRounds::bytes({});
    std::map<std::uint64_t, std::size_t> reads;
    std::uint64_t before = 0;
    smoothed_codes<float>(
        volume.grid,
        [&](std::uint64_t k, std::span<std::byte> to) {
          EXPECT_TRUE(k == 0 || k == before + 1);
          before = k;
          ++reads[k];
          volume.planes()(k, to);
        },
        options, [](const std::vector<OctahedralCode>&) {}, SilentProgress::instance());
    // Each strip needs twelve rows more on either side.
    const std::size_t strips = rows == 100 ? 1 : (100 + rows - 25) / (rows - 24);
    ASSERT_EQ(reads.size(), 11u);
    for (const auto& [k, times] : reads) EXPECT_EQ(times, 1 + strips) << k;
  }
}

TEST(SmoothedGradients, HugeOnesStayFinite) {
  std::mt19937 random(3);
  const Volume volume({12, 10, 9}, {1e-3, 1e-3, 1e-3}, [&](double i, double j, double k) {
    if (i == 5 && j == 5 && k == 5) return static_cast<double>(INFINITY);
    return (random() % 2 == 0 ? 3e38 : -3e38) * (i + 1) / 13;
  });
  for (const OctahedralCode& code : volume.in_strips({})) {
    const Vec3 direction = decode_octahedral({code[0], code[1]});
    const double length = norm(direction);
    ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-6);
  }
}

/// Returns the mean angle, in degrees, between the stored directions round a noisy sphere and the true ones.
double mean_angle(const Volume& volume, const Vec3& centre, bool smooth) {
  const test::Scratch folder;
  StoreOptions options;
  options.gradients = true;
  if (!smooth) options.smoothing.reset();
  options.scratch = folder / "";
  test::build_store(folder / "s.adm", "s.adm", volume.grid, volume.planes(), options);
  StoreFile file(folder / "s.adm");
  StoredGradients gradients(file, 0, std::size_t{1} << 26);
  double sum = 0;
  std::size_t count = 0;
  LatticePoint p{};
  for (p.k = 0; p.k < 40; ++p.k)
    for (p.j = 0; p.j < 40; ++p.j)
      for (p.i = 0; p.i < 40; ++p.i) {
        const Vec3 out = Vec3{double(p.i), double(p.j), double(p.k)} - centre;
        if (std::abs(norm(out) - 12) > 1.5) continue;
        const auto found = gradients.direction(p);
        if (!found) continue;
        sum += std::acos(std::clamp(dot(*found, out) / norm(out), -1.0, 1.0)) * 180 / M_PI;
        ++count;
      }
  EXPECT_GT(count, 4000u);
  return sum / static_cast<double>(count);
}

TEST(SmoothedGradients, AreNearerToTheTrueDirectionsOfANoisySphere) {
  const Vec3 centre{19.3, 20.1, 18.6};
  std::mt19937 random(11);
  std::normal_distribution<double> noise(0, 2);
  const Volume volume({40, 40, 40}, {1, 1, 1}, [&](double i, double j, double k) {
    const double r = norm(Vec3{i, j, k} - centre);
    return 10 * r + noise(random);
  });
  const double raw = mean_angle(volume, centre, false), smooth = mean_angle(volume, centre, true);
  EXPECT_GT(raw, 2);
  EXPECT_LT(smooth, raw / 2) << raw;
}

TEST(SmoothedGradients, StoresHoldThem) {
  const Volume volume = rough({40, 37, 50});
  const test::Scratch folder;
  StoreOptions options;
  options.gradients = true;
  options.scratch = folder / "";
  test::build_store(folder / "s.adm", "s.adm", volume.grid, volume.planes(), options);
  StoreFile file(folder / "s.adm");
  StoredGradients gradients(file, 0, std::size_t{1} << 26);
  const std::vector<OctahedralCode> codes = volume.smoothed();
  for (std::size_t n = 0; n < codes.size(); ++n) {
    const auto at = [n](std::size_t stride, std::size_t count) {
      return static_cast<std::int32_t>(n / stride % count);
    };
    const auto found = gradients.direction({at(1, 40), at(40, 37), at(std::size_t{40} * 37, 50)});
    ASSERT_TRUE(found);
    const Vec3 expected = decode_octahedral({codes[n][0], codes[n][1]});
    ASSERT_EQ(norm(*found - expected), 0) << n;
  }
}

}  // namespace
}  // namespace adamas
