#include "isosurface/gradients/plane_gradients.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "core/base/parallel.h"
#include "isosurface/gradients/octahedral_codes.h"

namespace adamas {

using namespace isosurface;

namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

template <class Sample>
struct Volume {
  std::array<std::size_t, 3> sizes;
  std::vector<Sample> samples;

  explicit Volume(const std::array<std::size_t, 3>& n) : sizes(n), samples(n[0] * n[1] * n[2]) {}
  [[nodiscard]] std::array<const Sample*, 3> planes(std::size_t k) const {
    const auto plane = [&](std::size_t at) {
      return at < sizes[2] ? samples.data() + at * sizes[0] * sizes[1] : nullptr;
    };
    return {plane(k - 1), plane(k), plane(k + 1)};
  }
  [[nodiscard]] Neighbourhood round(std::size_t i, std::size_t j, std::size_t k) const {
    Neighbourhood values;
    for (std::size_t n = 0; n < 27; ++n) {
      const std::size_t x = i + n % 3 - 1, y = j + n / 3 % 3 - 1, z = k + n / 9 - 1;
      values[n] = x < sizes[0] && y < sizes[1] && z < sizes[2]
                      ? double{static_cast<double>(samples[x + sizes[0] * (y + sizes[1] * z)])}
                      : double{kNothing};
    }
    return values;
  }
};

/// Returns the greatest difference of values in a neighbourhood, divided by the least spacing. Rounding
/// errors are compared with it.
double steepness(const Neighbourhood& values, const Vec3& spacing) {
  double least = INFINITY, greatest = -INFINITY;
  for (const double v : values) {
    if (std::isfinite(v)) least = std::min(least, v), greatest = std::max(greatest, v);
  }
  return greatest > least ? (greatest - least) / std::min({spacing.x, spacing.y, spacing.z}) : 0;
}

Vec3 decoded(const OctahedralCode& code) { return decode_octahedral({code[0], code[1]}); }

/// Expects that gradients are those of the estimator up to rounding, and that codes are the same or equally
/// near.
template <class Sample>
void expect_estimates(const Volume<Sample>& volume, const Vec3& spacing) {
  const auto [nx, ny, nz] = volume.sizes;
  const PlaneGradients of_plane(spacing, nx, ny);
  const GradientEstimator estimate(spacing);
  std::vector<Gradient> gradients(nx * ny);
  std::vector<OctahedralCode> codes(nx * ny);
  for (std::size_t k = 0; k < nz; ++k) {
    of_plane(volume.planes(k), std::span(gradients));
    of_plane(volume.planes(k), std::span(codes));
    for (std::size_t at = 0; at < gradients.size(); ++at) {
      const Neighbourhood values = volume.round(at % nx, at / nx, k);
      const Vec3 expected = estimate(values);
      const auto [x, y, z] = gradients[at];
      const double scale = steepness(values, spacing);
      ASSERT_LE(norm(Vec3{x, y, z} - expected), 1e-7 * norm(expected) + 1e-14 * scale) << at << " of " << k;
      if (norm(expected) < 1e-12 * scale) continue;  // what is left is rounding
      const auto bytes = encode_octahedral(expected);
      if (codes[at] == OctahedralCode{bytes[0], bytes[1]}) continue;
      const Vec3 unit = normalized(expected);
      ASSERT_NEAR(dot(unit, decoded(codes[at])), dot(unit, decoded({bytes[0], bytes[1]})), 1e-11)
          << at << " of " << k;
    }
  }
}

template <class Sample>
class PlaneGradientsOf : public ::testing::Test {};
using Samples = ::testing::Types<std::uint8_t, std::uint16_t, std::int16_t, float>;
TYPED_TEST_SUITE(PlaneGradientsOf, Samples);

TYPED_TEST(PlaneGradientsOf, GradientsAreThoseOfTheEstimator) {
  std::mt19937 random(6);
  for (const Vec3& spacing : {Vec3{1, 1, 1}, {0.5, 2, 1.25}, {1e-3, 40, 1}}) {
    for (const std::array<std::size_t, 3>& sizes : {std::array<std::size_t, 3>{23, 12, 6},
                                                    {1, 1, 1},
                                                    {2, 2, 2},
                                                    {3, 3, 3},
                                                    {1, 9, 4},
                                                    {9, 1, 3},
                                                    {300, 3, 3}}) {
      Volume<TypeParam> volume(sizes);
      for (TypeParam& v : volume.samples) v = static_cast<TypeParam>(random());
      expect_estimates(volume, spacing);
      // With only two values many gradients are zero, and many directions lie exactly between codes.
      for (TypeParam& v : volume.samples) v = static_cast<TypeParam>(100 + (random() % 8 == 0 ? 1 : 0));
      expect_estimates(volume, spacing);
    }
  }
}

TYPED_TEST(PlaneGradientsOf, EqualSamplesHaveNoDirection) {
  Volume<TypeParam> volume({40, 7, 3});
  std::fill(volume.samples.begin(), volume.samples.end(), static_cast<TypeParam>(201));
  std::vector<OctahedralCode> codes(40 * 7, {1, 1});
  std::vector<Gradient> gradients(40 * 7, {1, 1, 1});
  const PlaneGradients of_plane({0.3, 0.7, 0.9}, 40, 7);
  for (std::size_t k = 0; k < 3; ++k) {
    of_plane(volume.planes(k), std::span(codes));
    of_plane(volume.planes(k), std::span(gradients));
    for (const OctahedralCode& code : codes) EXPECT_EQ(code, OctahedralCode{});
    for (const Gradient& g : gradients) EXPECT_EQ(g, Gradient{});
  }
}

TEST(PlaneGradients, SamplesThatAreNotFiniteAreLeftOut) {
  std::mt19937 random(12);
  std::normal_distribution<float> number;
  for (const unsigned one_of : {200u, 30u, 3u}) {
    Volume<float> volume({31, 14, 6});
    for (float& v : volume.samples) {
      v = number(random);
      if (random() % one_of == 0)
        v = random() % 3 == 0 ? kInfinity : random() % 2 == 0 ? -kInfinity : kNothing;
    }
    expect_estimates(volume, {1, 0.5, 2});
  }
}

TEST(PlaneGradients, OfFloatsOfAnySize) {
  std::mt19937 random(13);
  std::normal_distribution<float> number;
  for (const float offset : {0.0F, 1e6F}) {
    for (const float scale : {1e-42F, 1e-30F, 1.0F, 1e30F}) {
      Volume<float> volume({20, 8, 5});
      for (float& v : volume.samples) v = scale * (offset + number(random));
      const PlaneGradients of_plane({1, 1, 1}, 20, 8);
      const GradientEstimator estimate({1, 1, 1});
      std::vector<OctahedralCode> codes(160);
      of_plane(volume.planes(2), std::span(codes));
      for (std::size_t at = 0; at < codes.size(); ++at) {
        const Vec3 expected = estimate(volume.round(at % 20, at / 20, 2));
        if (norm(expected) == 0) continue;
        EXPECT_GT(dot(normalized(expected), decoded(codes[at])), 0.9999);
      }
    }
  }
}

TEST(PlaneGradients, AreTheSameOnAnyNumberOfThreads) {
  Volume<std::uint8_t> volume({200, 300, 3});
  std::mt19937 random(14);
  for (std::uint8_t& v : volume.samples) v = static_cast<std::uint8_t>(random());
  const PlaneGradients of_plane({1, 2, 3}, 200, 300);
  std::vector<std::vector<OctahedralCode>> results;
  for (const unsigned threads : {1u, 2u, 5u}) {
    set_thread_limit(threads);
    results.emplace_back(200 * 300);
    of_plane(volume.planes(1), std::span(results.back()));
  }
  set_thread_limit(0);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace adamas
