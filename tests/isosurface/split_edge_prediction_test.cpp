#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "core/lattice/diamond.h"
#include "isosurface/compression/page_order.h"
#include "isosurface/compression/split_edge/residual_code.h"
#include "isosurface/volume/samples.h"
#include "isosurface/volume/z_order.h"

namespace adamas {

using namespace isosurface;

namespace {

using Dimensions = std::array<std::int32_t, 3>;

/// Returns the number of bits per coordinate that hold all samples and the lattice's last point.
int bits_for(const Dimensions& n) {
  const int steps = std::max({n[0], n[1], n[2]}) - 1;
  return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(steps, 1) - 1))) + 1;
}

/// Returns the data's points in hierarchical z-order.
std::vector<LatticePoint> points_of(const Dimensions& n) {
  const ZOrder order(bits_for(n));
  std::vector<LatticePoint> points;
  for (std::int32_t k = 0; k < n[2]; ++k) {
    for (std::int32_t j = 0; j < n[1]; ++j) {
      for (std::int32_t i = 0; i < n[0]; ++i) points.push_back({i, j, k});
    }
  }
  std::sort(points.begin(), points.end(),
            [&](LatticePoint a, LatticePoint b) { return order.index(a) < order.index(b); });
  return points;
}

std::size_t at(const Dimensions& n, LatticePoint p) {
  return static_cast<std::size_t>(p.i + n[0] * (p.j + n[1] * p.k));
}

template <class Visit>
void for_all_dimensions(std::int32_t most, Visit&& visit) {
  for (std::int32_t a = 1; a <= most; ++a) {
    for (std::int32_t b = 1; b <= most; ++b) {
      for (std::int32_t c = 1; c <= most; ++c) visit(Dimensions{a, b, c});
    }
  }
}

TEST(SplitEdgePrediction, IsFromSamplesOfCoarserLods) {
  for_all_dimensions(9, [](const Dimensions& n) {
    for (const LatticePoint p : points_of(n)) {
      if (p == LatticePoint{0, 0, 0}) continue;
      for (const LatticePoint end : predictors(p, n)) {
        for (int axis = 0; axis < 3; ++axis) {
          ASSERT_GE(end[axis], 0);
          ASSERT_LT(end[axis], n[static_cast<std::size_t>(axis)]);
        }
        // In the same lattice a coarser point has fewer odd coordinates. Of the root's corners only 0 comes
        // before.
        const bool is_corner = trailing_zeros(p) + 1 >= bits_for(n);
        const auto odd = [&](LatticePoint q) {
          const int t = trailing_zeros(p);
          return (q.i >> t & 1) + (q.j >> t & 1) + (q.k >> t & 1);
        };
        ASSERT_TRUE(is_corner || odd(end) < odd(p));
      }
    }
  });
}

TEST(SplitEdgePrediction, IsTheDiamondsSplitEdgeInside) {
  constexpr int kShift = kRootBits - 3;
  const Dimensions n{9, 9, 9};
  for (const LatticePoint p : points_of(n)) {
    const LatticePoint fine{p.i << kShift, p.j << kShift, p.k << kShift};
    if (trailing_zeros(fine) >= kRootBits) continue;
    auto [a, b] = Diamond(fine).split_edge();
    const auto [x, y] = predictors(p, n);
    EXPECT_EQ((LatticePoint{a.i >> kShift, a.j >> kShift, a.k >> kShift}), x);
    EXPECT_EQ((LatticePoint{b.i >> kShift, b.j >> kShift, b.k >> kShift}), y);
  }
}

/// Expects that samples come back from residuals and their code, LOD after LOD.
template <class Sample>
void expect_lossless(const Dimensions& n, const std::vector<Sample>& samples) {
  const auto points = points_of(n);
  constexpr int kBits = 8 * sizeof(Sample);
  constexpr std::uint32_t kMask = kBits == 32 ? ~0u : (1u << (kBits % 32)) - 1;
  std::vector<std::uint32_t> residuals{ordered(samples[0])};
  for (std::size_t x = 1; x < points.size(); ++x) {
    const auto [a, b] = predictors(points[x], n);
    const std::uint32_t guess = predicted(ordered(samples[at(n, a)]), ordered(samples[at(n, b)]));
    residuals.push_back((ordered(samples[at(n, points[x])]) - guess) & kMask);
  }
  ResidualStatistics statistics(kBits);
  statistics.add(residuals);
  const ResidualCode code(statistics);
  std::vector<std::byte> page;
  code.encode(residuals, page);
  std::vector<std::uint32_t> decoded(points.size());
  ASSERT_TRUE(code.decode(page, decoded));
  std::vector<Sample> found(samples.size());
  found[0] = from_ordered<Sample>(decoded[0]);
  for (std::size_t x = 1; x < points.size(); ++x) {
    const auto [a, b] = predictors(points[x], n);
    const std::uint32_t guess = predicted(ordered(found[at(n, a)]), ordered(found[at(n, b)]));
    found[at(n, points[x])] = from_ordered<Sample>((guess + decoded[x]) & kMask);
  }
  ASSERT_EQ(std::memcmp(found.data(), samples.data(), samples.size() * sizeof(Sample)), 0);
}

template <class Sample>
std::vector<Sample> random_samples(const Dimensions& n, std::mt19937& random) {
  std::vector<Sample> samples(static_cast<std::size_t>(n[0] * n[1] * n[2]));
  for (Sample& s : samples) {
    if constexpr (std::is_same_v<Sample, float>) {
      s = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    } else {
      s = static_cast<Sample>(random());
    }
  }
  return samples;
}

TEST(SplitEdgePrediction, IsLosslessForEveryDimensionAndType) {
  std::mt19937 random(1);
  for_all_dimensions(9, [&](const Dimensions& n) {
    if ((n[0] + n[1] + n[2]) % 3 != 0) return;
    expect_lossless(n, random_samples<std::uint8_t>(n, random));
    expect_lossless(n, random_samples<std::uint16_t>(n, random));
    expect_lossless(n, random_samples<std::int16_t>(n, random));
    expect_lossless(n, random_samples<float>(n, random));
    expect_lossless(n, std::vector<std::uint8_t>(static_cast<std::size_t>(n[0] * n[1] * n[2]), 7));
  });
}

TEST(SplitEdgePrediction, OrdersFloatsAndKeepsTheirBits) {
  const float inf = std::numeric_limits<float>::infinity(), tiny = std::numeric_limits<float>::denorm_min();
  const float ascending[] = {-inf, -1e30f, -1, -tiny, -0.0f, 0.0f, tiny, 1, 1e30f, inf};
  for (std::size_t x = 1; x < std::size(ascending); ++x)
    EXPECT_LT(ordered(ascending[x - 1]), ordered(ascending[x]));
  EXPECT_LT(ordered(std::int16_t{-32768}), ordered(std::int16_t{-1}));
  EXPECT_LT(ordered(std::int16_t{-1}), ordered(std::int16_t{32767}));
  for (const std::uint32_t word :
       {0x7fc00001u, 0xffc12345u, 0x7f800001u, 0x80000000u, 0x00000001u, 0x807fffffu}) {
    // Bits are compared, since a signalling NaN may change on its way through a register.
    const auto value = (word & 0x80000000u) != 0 ? ~word : word | 0x80000000u;
    EXPECT_EQ(std::bit_cast<std::uint32_t>(from_ordered<float>(value)), word);
  }
}

}  // namespace
}  // namespace adamas
