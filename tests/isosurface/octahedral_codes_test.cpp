#include "isosurface/gradients/octahedral_codes.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "isosurface/gradients/direction_code.h"

namespace adamas {

using namespace isosurface;

namespace {

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
    const auto expected = encode_direction(DirectionCode::kOctahedral, directions[i]);
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
    // Near the planes and axes too, and of any length.
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
  // Between the directions of neighbouring codes.
  for (int n = 0; n < 60000; ++n) {
    const auto a = static_cast<std::uint8_t>(n % 245 + 5), b = static_cast<std::uint8_t>(n / 245 + 5);
    const Vec3 here = decode_direction(DirectionCode::kOctahedral, {a, b, 0});
    const Vec3 next =
        decode_direction(DirectionCode::kOctahedral,
                         {static_cast<std::uint8_t>(a + n % 2), static_cast<std::uint8_t>(b + n / 2 % 2), 0});
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
    const auto expected = encode_direction(DirectionCode::kOctahedral, {x, y, z});
    EXPECT_EQ(codes[i], (OctahedralCode{expected[0], expected[1]}));
  }
}

}  // namespace
}  // namespace adamas
