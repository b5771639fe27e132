#include "isosurface/gradients/direction_code.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace adamas {

using namespace isosurface;

namespace {

constexpr DirectionCode kCodes[] = {DirectionCode::kOctahedral, DirectionCode::kComponents,
                                    DirectionCode::kTwoComponents};

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

Vec3 decoded(DirectionCode code, const Vec3& direction) {
  return decode_direction(code, encode_direction(code, direction));
}

double worst_of_random(DirectionCode code) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int trial = 0; trial < 300000; ++trial) {
    Vec3 n{normal(random), normal(random), normal(random)};
    // Near the planes and axes too, where codes are at their worst.
    if (trial % 3 == 1) n[trial % 9 / 3] *= 0.02;
    if (trial % 3 == 2) n[trial % 9 / 3] *= 50;
    worst = std::max(worst, degrees_between(n, decoded(code, n)));
  }
  return worst;
}

TEST(DirectionCode, IsAsGoodAsItSays) {
  const double octahedral = worst_of_random(DirectionCode::kOctahedral);
  EXPECT_LT(octahedral, 0.64);
  EXPECT_GT(octahedral, 0.5);
  const double components = worst_of_random(DirectionCode::kComponents);
  EXPECT_LT(components, 0.39);
  EXPECT_GT(components, 0.3);
  const double two = worst_of_random(DirectionCode::kTwoComponents);
  EXPECT_LT(two, 5.2);
  EXPECT_GT(two, 4.5);
}

TEST(DirectionCode, HasTheAxes) {
  for (const DirectionCode code : kCodes) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Vec3 n;
        n[axis] = 1e-3 * side;
        EXPECT_LT(degrees_between(n, decoded(code, n)), 1e-6);
      }
    }
  }
}

TEST(DirectionCode, OfNoDirectionIsZero) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const DirectionCode code : kCodes) {
    for (const Vec3& v : {Vec3{}, Vec3{nan, 0, 1}, Vec3{0, inf, 0}}) EXPECT_EQ(norm(decoded(code, v)), 0);
    for (const double scale : {1e-300, 1e300})
      EXPECT_LT(degrees_between({1, 2, 3}, decoded(code, scale * Vec3{1, 2, 3})), 5.2);
  }
}

/// Any bytes decode to a unit vector or zero, and what is decoded is coded as the same vector.
TEST(DirectionCode, OfEveryCodeIsStable) {
  for (const DirectionCode code : kCodes) {
    for (unsigned bits = 0; bits < 1u << 16; ++bits) {
      const std::array<std::uint8_t, 3> bytes{
          static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
          static_cast<std::uint8_t>(direction_bytes(code) == 3 ? 37 * bits : 0)};
      const Vec3 n = decode_direction(code, bytes);
      const double length = norm(n);
      ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-12);
      if (code == DirectionCode::kOctahedral) {
        ASSERT_LT(degrees_between(n, decoded(code, n)), 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace adamas
