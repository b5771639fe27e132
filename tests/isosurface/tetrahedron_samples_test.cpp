#include "isosurface/preprocessing/tetrahedron_samples.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "core/geometry/tetrahedron.h"
#include "core/lattice/diamond.h"
#include "isosurface/preprocessing/tetrahedron_stencils.h"

namespace adamas {
namespace {

constexpr int kSide = 17;

/// Samples of a block with corners (0, 0, 0) and (16, 16, 16).
template <class Sample>
struct Cube {
  explicit Cube(std::mt19937& random) : samples(kSide * kSide * kSide) {
    for (Sample& s : samples) s = static_cast<Sample>(random());
  }
  [[nodiscard]] SampleBlock<Sample> block() const {
    return {{0, 0, 0}, {kSide, kSide, kSide}, samples.data()};
  }
  [[nodiscard]] Sample at(LatticePoint p) const {
    return samples[static_cast<std::size_t>(p.i + kSide * (p.j + kSide * p.k))];
  }
  std::vector<Sample> samples;
};

using Corners = TetrahedronRows::Corners;

bool inside(const Corners& corners) {
  return std::all_of(corners.begin(), corners.end(), [](LatticePoint p) {
    return std::min({p.i, p.j, p.k}) >= 0 && std::max({p.i, p.j, p.k}) < kSide;
  });
}

/// All tetrahedra that bisection makes in the cube, down to those of one cell.
std::vector<Corners> all_tetrahedra() {
  std::vector<Corners> result;
  constexpr int kShift = kRootBits - 4;
  // At twice the resolution, since those of one cell would be split between the samples.
  for (int k = 0; k < 2 * kSide; ++k) {
    for (int j = 0; j < 2 * kSide; ++j) {
      for (int i = 0; i < 2 * kSide; ++i) {
        const LatticePoint p{i << (kShift - 1), j << (kShift - 1), k << (kShift - 1)};
        if (trailing_zeros(p) >= kRootBits) continue;
        const Diamond diamond(p);
        for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
          Corners corners = diamond.tetrahedron(slot);
          const bool on_samples = std::all_of(corners.begin(), corners.end(),
                                              [](LatticePoint c) { return trailing_zeros(c) >= kShift; });
          for (LatticePoint& c : corners) c = {c.i >> kShift, c.j >> kShift, c.k >> kShift};
          if (on_samples && inside(corners)) result.push_back(corners);
        }
      }
    }
  }
  return result;
}

template <class Sample>
std::array<double, 4> values_at(const Cube<Sample>& cube, const Corners& corners) {
  std::array<double, 4> values{};
  for (std::size_t c = 0; c < 4; ++c) values[c] = cube.at(corners[c]);
  return values;
}

/// Point by point, by barycentric weights in floating point.
template <class Sample>
SampleDeviation by_points(const Cube<Sample>& cube, const Corners& corners) {
  const auto place = [](LatticePoint p) {
    return Vec3{static_cast<double>(p.i), static_cast<double>(p.j), static_cast<double>(p.k)};
  };
  const Tetrahedron cell({place(corners[0]), place(corners[1]), place(corners[2]), place(corners[3])});
  const auto values = values_at(cube, corners);
  SampleDeviation result;
  for (int k = 0; k < kSide; ++k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const Weights w = cell.weights(place({i, j, k}));
        if (std::min({w[0], w[1], w[2], w[3]}) < -1e-9) continue;
        const double sample = cube.at({i, j, k});
        const double linear = w[0] * values[0] + w[1] * values[1] + w[2] * values[2] + w[3] * values[3];
        result.error = std::max(result.error, std::abs(linear - sample));
        result.min = std::min(result.min, sample);
        result.max = std::max(result.max, sample);
      }
    }
  }
  return result;
}

TEST(TetrahedronRows, AgreesWithBarycentricWeightsEverywhere) {
  std::mt19937 random(1);
  const Cube<std::uint8_t> bytes(random);
  const Cube<std::int16_t> shorts(random);
  const auto tetrahedra = all_tetrahedra();
  // 16^3 cells of six, and as much again by each coarser level but for its greater volume.
  EXPECT_GT(tetrahedra.size(), 6u * 16 * 16 * 16);
  for (std::size_t t = 0; t < tetrahedra.size(); ++t) {
    const Corners& corners = tetrahedra[t];
    // All large ones, and some of the many small ones.
    if (std::abs(corners[0].i - corners[1].i) + std::abs(corners[0].j - corners[1].j) < 4 && t % 23 != 0)
      continue;
    const TetrahedronRows rows(corners);
    SampleDeviation found;
    rows.measure(bytes.block(), values_at(bytes, corners), found);
    SampleDeviation wanted = by_points(bytes, corners);
    ASSERT_NEAR(found.error, wanted.error, 1e-9);
    ASSERT_EQ(found.min, wanted.min);
    ASSERT_EQ(found.max, wanted.max);
    SampleDeviation of_shorts;
    rows.measure(shorts.block(), values_at(shorts, corners), of_shorts);
    wanted = by_points(shorts, corners);
    ASSERT_NEAR(of_shorts.error, wanted.error, 1e-7);
    ASSERT_EQ(of_shorts.min, wanted.min);
  }
}

TEST(TetrahedronRows, PartsOfAVolumeAddUp) {
  std::mt19937 random(2);
  const Cube<std::uint16_t> cube(random);
  for (const Corners& corners : all_tetrahedra()) {
    if (random() % 40 != 0) continue;
    const TetrahedronRows rows(corners);
    const auto values = values_at(cube, corners);
    SampleDeviation whole, parts;
    rows.measure(cube.block(), values, whole);
    // Slabs of a few planes.
    for (std::int32_t k = 0; k < kSide; k += 3) {
      const std::int32_t planes = std::min(3, kSide - k);
      const SampleBlock<std::uint16_t> slab{
          {0, 0, k}, {kSide, kSide, planes}, cube.samples.data() + kSide * kSide * k};
      rows.measure(slab, values, parts);
    }
    ASSERT_EQ(parts.error, whole.error);
    ASSERT_EQ(parts.min, whole.min);
    ASSERT_EQ(parts.max, whole.max);
  }
}

TEST(TetrahedronStencils, AgreeWithRows) {
  std::mt19937 random(3);
  const Cube<std::uint16_t> shorts(random);
  Cube<float> floats(random);
  floats.samples[4000] = std::numeric_limits<float>::quiet_NaN();
  const TetrahedronStencils stencils({kSide, kSide, kSide});
  constexpr int kShift = kRootBits - 4;
  std::array<int, TetrahedronStencils::kScales> seen{};
  const auto compare = [&](const auto& cube, const Diamond& diamond, LatticePoint p, int slot,
                           const Corners& corners) {
    const int bits = diamond.scale_bits() - kShift;
    const auto* split_vertex = cube.samples.data() + p.i + kSide * (p.j + kSide * p.k);
    const auto values = values_at(cube, corners);
    for (std::size_t c = 0; c < 4; ++c) {
      const double value = split_vertex[stencils.corners(bits, diamond.type_index(), slot)[c]];
      if (!std::isnan(value)) {
        ASSERT_EQ(value, values[c]);
      }
    }
    if (std::isnan(values[0] + values[1] + values[2] + values[3])) return;
    SampleDeviation wanted;
    TetrahedronRows(corners).measure(cube.block(), values, wanted);
    const double found = stencils.error(split_vertex, bits, diamond.type_index(), slot, values);
    ASSERT_NEAR(found, wanted.error, 1e-12 * (1 + wanted.error));
    ++seen[static_cast<std::size_t>(bits)];
  };
  for (int index = 0; index < kSide * kSide * kSide; ++index) {
    const LatticePoint p{index % kSide, index / kSide % kSide, index / kSide / kSide};
    if (trailing_zeros(p) >= TetrahedronStencils::kScales) continue;
    const Diamond diamond({p.i << kShift, p.j << kShift, p.k << kShift});
    for (int slot = 0; slot < diamond.tetrahedron_count(); ++slot) {
      Corners corners = diamond.tetrahedron(slot);
      for (LatticePoint& c : corners) c = {c.i >> kShift, c.j >> kShift, c.k >> kShift};
      if (!inside(corners)) continue;
      compare(shorts, diamond, p, slot, corners);
      compare(floats, diamond, p, slot, corners);
      if (testing::Test::HasFatalFailure()) return;
    }
  }
  EXPECT_GT(*std::min_element(seen.begin(), seen.end()), 500);
}

TEST(TetrahedronRows, LinearDataHaveNoErrorAndHolesDoNotCount) {
  std::vector<float> samples;
  for (int k = 0; k < 9; ++k) {
    for (int j = 0; j < 9; ++j) {
      for (int i = 0; i < 9; ++i) samples.push_back(static_cast<float>(3 * i - 2 * j + k));
    }
  }
  const TetrahedronRows rows({LatticePoint{0, 0, 0}, {8, 8, 8}, {8, 0, 0}, {8, 8, 0}});
  const std::array<double, 4> values{0, 16, 24, 8};
  const auto at = [](int i, int j, int k) { return static_cast<std::size_t>(i + 9 * (j + 9 * k)); };
  samples[at(7, 3, 1)] = std::numeric_limits<float>::quiet_NaN();
  samples[at(6, 2, 1)] = std::numeric_limits<float>::infinity();
  const SampleBlock<float> block{{0, 0, 0}, {9, 9, 9}, samples.data()};
  SampleDeviation found;
  rows.measure(block, values, found);
  EXPECT_EQ(found.error, 0);
  EXPECT_EQ(found.min, 0);
  EXPECT_EQ(found.max, 24);
  samples[at(5, 1, 0)] += 0.5f;
  samples[at(1, 5, 0)] += 9;  // outside
  rows.measure(block, values, found);
  EXPECT_EQ(found.error, 0.5);
  SampleDeviation of_nothing;
  rows.measure(SampleBlock<float>{{20, 0, 0}, {2, 9, 9}, samples.data()}, values, of_nothing);
  EXPECT_EQ(of_nothing.error, 0);
  EXPECT_GT(of_nothing.min, of_nothing.max);
}

}  // namespace
}  // namespace adamas
