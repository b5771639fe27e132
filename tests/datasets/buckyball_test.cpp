// Tests the synthetic volume: its atoms, its values, and that the number of threads changes no byte.

#include "datasets/buckyball.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "core/base/parallel.h"
#include "tests/support/scratch.h"

namespace adamas {

using namespace datasets;

namespace {

using Dimensions = std::array<std::uint64_t, 3>;

std::vector<std::byte> all_planes(const Buckyball& ball) {
  const VolumeGrid& grid = ball.grid();
  std::vector<std::byte> samples(grid.plane_bytes() * grid.dimensions[2]);
  for (std::uint64_t k = 0; k < grid.dimensions[2]; ++k) {
    ball.plane(k, std::span(samples).subspan(k * grid.plane_bytes(), grid.plane_bytes()));
  }
  return samples;
}

template <class T>
std::vector<T> samples_of(const Buckyball& ball) {
  const auto bytes = all_planes(ball);
  std::vector<T> samples(bytes.size() / sizeof(T));
  std::memcpy(samples.data(), bytes.data(), bytes.size());
  return samples;
}

/// Returns the place of a sample in the cube [-1, 1]^3.
Vec3 place(const Dimensions& n, std::size_t i, std::size_t j, std::size_t k) {
  const auto at = [](std::size_t index, std::uint64_t count) {
    return count > 1 ? -1 + 2 * static_cast<double>(index) / static_cast<double>(count - 1) : 0;
  };
  return {at(i, n[0]), at(j, n[1]), at(k, n[2])};
}

TEST(Buckyball, EveryAtomHasThreeNeighboursAndOneOpposite) {
  const auto atoms = buckyball_atoms();
  const double radius = norm(atoms[0]);
  // This is the ratio of circumradius and edge of a truncated icosahedron.
  const double edge = radius / 2.47801866;
  for (const Vec3& a : atoms) {
    EXPECT_NEAR(norm(a), radius, 1e-14);
    std::size_t neighbours = 0, opposite = 0;
    for (const Vec3& b : atoms) {
      const double d = distance(a, b);
      EXPECT_TRUE(&a == &b || d > edge * (1 - 1e-7)) << d;
      neighbours += std::abs(d - edge) < 1e-7;
      opposite += norm(a + b) < 1e-14;
    }
    EXPECT_EQ(neighbours, 3u);
    EXPECT_EQ(opposite, 1u);
  }
}

TEST(Buckyball, ValuesHaveItsSymmetryAndFallOffAtTheSides) {
  for (const Vec3& atom : buckyball_atoms()) {
    EXPECT_NEAR(buckyball_value(atom), buckyball_value(buckyball_atoms()[0]), 1e-14);
    // An atom's neighbours move the greatest value a little away from it.
    EXPECT_GT(buckyball_value(atom), 0.9999);
    EXPECT_LE(buckyball_value(atom), 1);
  }
  for (const Vec3 p : {Vec3{0.3, 0.5, -0.4}, Vec3{-0.7, 0.1, 0.2}, Vec3{0.1, 0.6, 0.3}}) {
    EXPECT_NEAR(buckyball_value(p), buckyball_value(-p), 1e-15);
    EXPECT_GT(std::abs(buckyball_value(p) - buckyball_value({-p.x, p.y, p.z})), 1e-4) << "no mirror in x";
  }
  EXPECT_LT(buckyball_value({1, 0, 0}), 1e-3);
}

TEST(Buckyball, SamplesAreTheSumOfAllGaussians) {
  for (const Dimensions n : {Dimensions{1, 1, 1}, Dimensions{2, 1, 1}, Dimensions{1, 7, 1},
                             Dimensions{1, 1, 5}, Dimensions{9, 17, 23}, Dimensions{40, 3, 11}}) {
    const Buckyball ball(n, SampleType::kFloat32);
    const auto floats = samples_of<float>(ball);
    ASSERT_EQ(floats.size(), n[0] * n[1] * n[2]);
    const auto bytes = samples_of<std::uint8_t>({n, SampleType::kUint8});
    const auto words = samples_of<std::uint16_t>({n, SampleType::kUint16});
    const auto shorts = samples_of<std::int16_t>({n, SampleType::kInt16});
    std::size_t at = 0;
    for (std::size_t k = 0; k < n[2]; ++k) {
      for (std::size_t j = 0; j < n[1]; ++j) {
        for (std::size_t i = 0; i < n[0]; ++i, ++at) {
          const double value = buckyball_value(place(n, i, j, k));
          ASSERT_NEAR(floats[at], value, 1e-7) << i << " " << j << " " << k;
          ASSERT_NEAR(bytes[at], 255 * value, 0.5 + 1e-9);
          ASSERT_NEAR(words[at], 65535 * value, 0.5 + 1e-9);
          ASSERT_NEAR(shorts[at], 32767 * value, 0.5 + 1e-9);
        }
      }
    }
  }
}

TEST(Buckyball, TheGridSpansACube) {
  const VolumeGrid cube = Buckyball({64, 64, 64}, SampleType::kUint16).grid();
  EXPECT_EQ(cube.spacing, (Vec3{1, 1, 1}));
  EXPECT_EQ(cube.origin, Vec3{});
  const VolumeGrid flat = Buckyball({11, 6, 1}, SampleType::kUint8).grid();
  EXPECT_EQ(flat.spacing, (Vec3{1, 2, 10}));
  EXPECT_EQ(flat.origin, (Vec3{0, 0, 5}));
  Buckyball({1, 1, 1}, SampleType::kUint8).grid().check("one");
}

TEST(Buckyball, TheNumberOfThreadsChangesNothing) {
  const Buckyball ball({61, 45, 30}, SampleType::kFloat32);
  set_thread_limit(1);
  const auto one = all_planes(ball);
  set_thread_limit(2);
  const auto two = all_planes(ball);
  set_thread_limit(0);
  EXPECT_EQ(one, two);
}

/// Returns the number of cut edges. A closed surface has about twice as many triangles.
std::size_t cut_edges(const std::vector<std::uint8_t>& samples, std::size_t n, double isovalue) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < samples.size(); ++at) {
    const bool above = samples[at] > isovalue;
    const std::size_t i = at % n, j = at / n % n, k = at / n / n;
    if (i > 0) count += above != (samples[at - 1] > isovalue);
    if (j > 0) count += above != (samples[at - n] > isovalue);
    if (k > 0) count += above != (samples[at - n * n] > isovalue);
  }
  return count;
}

TEST(Buckyball, SurfacesOfTheUsualSizes) {
  constexpr std::size_t kSamples = 64;
  const auto samples = samples_of<std::uint8_t>({{kSamples, kSamples, kSamples}, SampleType::kUint8});
  EXPECT_EQ(*std::min_element(samples.begin(), samples.end()), 0);
  const double scale = 511.0 * 511 / (63.0 * 63) / 1e6;
  EXPECT_NEAR(2 * scale * static_cast<double>(cut_edges(samples, kSamples, 20.5)), 3.0, 0.1);
  EXPECT_NEAR(2 * scale * static_cast<double>(cut_edges(samples, kSamples, 80.5)), 2.05, 0.1);
  EXPECT_NEAR(2 * scale * static_cast<double>(cut_edges(samples, kSamples, 160.5)), 0.79, 0.05);
}

TEST(Buckyball, AbsurdDimensionsAreRefused) {
  for (const Dimensions n : {Dimensions{0, 4, 4}, Dimensions{4, 65537, 4}, Dimensions{4, 4, 1ull << 62}}) {
    const std::string message = test::error_of([&n] { Buckyball(n, SampleType::kUint8); });
    EXPECT_NE(message.find("expected from 1 to 65536 samples along each axis, found"), std::string::npos)
        << message;
  }
}

}  // namespace

}  // namespace adamas
