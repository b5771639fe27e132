#include "isosurface/gradients/octahedral_codes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace adamas {

using namespace isosurface;

namespace {

double degrees_between(const Vec3& a, const Vec3& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
}

Vec3 decoded(const Vec3& direction) { return decode_octahedral(encode_octahedral(direction)); }

TEST(OctahedralCode, IsAsGoodAsItSays) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int trial = 0; trial < 300000; ++trial) {
    Vec3 n{normal(random), normal(random), normal(random)};
    // Some directions are near the coordinate planes and axes, where the error of codes is greatest.
    if (trial % 3 == 1) n[trial % 9 / 3] *= 0.02;
    if (trial % 3 == 2) n[trial % 9 / 3] *= 50;
    worst = std::max(worst, degrees_between(n, decoded(n)));
  }
  EXPECT_LT(worst, 0.64);
  EXPECT_GT(worst, 0.5);
}

TEST(OctahedralCode, HasTheAxes) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 n;
      n[axis] = 1e-3 * side;
      EXPECT_LT(degrees_between(n, decoded(n)), 1e-6);
    }
  }
}

TEST(OctahedralCode, OfNoDirectionIsZero) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Vec3& v : {Vec3{}, Vec3{nan, 0, 1}, Vec3{0, inf, 0}}) EXPECT_EQ(norm(decoded(v)), 0);
  for (const double scale : {1e-300, 1e300})
    EXPECT_LT(degrees_between({1, 2, 3}, decoded(scale * Vec3{1, 2, 3})), 0.64);
}

/// Any two bytes decode to a unit vector or zero, and coding that vector preserves it.
TEST(OctahedralCode, OfEveryCodeIsStable) {
  for (unsigned bits = 0; bits < 1u << 16; ++bits) {
    const Vec3 n = decode_octahedral({static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)});
    const double length = norm(n);
    ASSERT_TRUE(length == 0 || std::abs(length - 1) < 1e-12);
    ASSERT_LT(degrees_between(n, decoded(n)), 1e-6);
  }
}

void expect_codes_of_one_by_one(const std::vector<Vec3>& directions) {
  std::vector<double> x, y, z;
  for (const Vec3& d : directions) {
    x.push_back(d.x);
    y.push_back(d.y);
    z.push_back(d.z);
  }
  std::vector<OctahedralCode> codes(directions.size());
  encode_octahedral(x, y, z, codes);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const auto expected = encode_octahedral(directions[i]);
    const Vec3& d = directions[i];
    ASSERT_EQ(codes[i], (OctahedralCode{expected[0], expected[1]})) << d.x << " " << d.y << " " << d.z;
  }
}

TEST(OctahedralCodes, AreThoseOfOneByOne) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  std::vector<Vec3> directions;
  for (int n = 0; n < 400000; ++n) {
    Vec3 d{normal(random), normal(random), normal(random)};
    // Some directions are near the coordinate planes and axes, and some are of any length.
    if (n % 4 == 1) d[n % 12 / 4] *= 0.01;
    if (n % 4 == 2) d[n % 12 / 4] *= 100;
    if (n % 4 == 3) d *= std::pow(10, 150 * normal(random));
    directions.push_back(d);
  }
  expect_codes_of_one_by_one(directions);
}

TEST(OctahedralCodes, AgreeWhereSeveralAreEquallyNear) {
  std::vector<Vec3> directions;
  for (int n = 0; n < 21 * 21 * 21; ++n) {
    const Vec3 d{n % 21 - 10.0, n / 21 % 21 - 10.0, n / 441 - 10.0};
    directions.push_back(d);
    directions.push_back((1 / 3.0) * d);
    directions.push_back({d.x * 1e-17, d.y, d.z});
  }
  // These directions lie between those of neighbouring codes.
  for (int n = 0; n < 60000; ++n) {
    const auto a = static_cast<std::uint8_t>(n % 245 + 5), b = static_cast<std::uint8_t>(n / 245 + 5);
    const Vec3 here = decode_octahedral({a, b});
    const Vec3 next =
        decode_octahedral({static_cast<std::uint8_t>(a + n % 2), static_cast<std::uint8_t>(b + n / 2 % 2)});
    directions.push_back(here);
    directions.push_back(here + next);
  }
  expect_codes_of_one_by_one(directions);
}

TEST(OctahedralCodes, OfWhatHasNoDirection) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity(),
                   kNothing = std::numeric_limits<double>::quiet_NaN();
  expect_codes_of_one_by_one({{0, 0, 0},
                              {-0.0, 0, -0.0},
                              {kInfinity, 0, 0},
                              {1, kNothing, 0},
                              {1e308, 1e308, -1e308},
                              {5e-324, 0, -5e-324},
                              {-1e308, 1e-308, 0}});
  expect_codes_of_one_by_one({});
}

TEST(OctahedralCodes, OfFloats) {
  std::mt19937 random(2);
  std::normal_distribution<float> normal;
  std::vector<Gradient> gradients(1000);
  for (Gradient& g : gradients) g = {normal(random), normal(random), normal(random)};
  gradients[700] = {};
  std::vector<OctahedralCode> codes(gradients.size());
  encode_octahedral(gradients, codes);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const auto [x, y, z] = gradients[i];
    const auto expected = encode_octahedral(Vec3{x, y, z});
    EXPECT_EQ(codes[i], (OctahedralCode{expected[0], expected[1]}));
  }
}

}  // namespace
}  // namespace adamas
