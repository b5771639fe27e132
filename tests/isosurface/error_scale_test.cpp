#include "isosurface/volume/error_scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace adamas {

using namespace isosurface;

namespace {

TEST(ErrorScale, IsNeverOptimisticAndNearlySharp) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-15, 0);
  for (const double greatest : {1e-300, 0.004, 1.0, 173.0, 1e300}) {
    const ErrorScale scale(greatest);
    EXPECT_EQ(scale.encode(0), 0);
    EXPECT_EQ(scale.decode(0), 0);
    EXPECT_EQ(scale.encode(greatest), ErrorScale::kCodes - 1);
    EXPECT_EQ(scale.decode(ErrorScale::kCodes - 1), greatest);
    for (int trial = 0; trial < 2000; ++trial) {
      const double error = greatest * std::exp2(exponent(random));
      const double coded = scale.decode(scale.encode(error));
      ASSERT_GE(coded, error);
      ASSERT_LE(coded, error * 1.1893);
    }
    EXPECT_EQ(scale.encode(greatest * 1e-9), 1);
  }
}

TEST(ErrorScale, CodesStayThemselves) {
  const ErrorScale scale(7.25);
  for (int code = 0; code < ErrorScale::kCodes; ++code) {
    const auto c = static_cast<std::uint8_t>(code);
    EXPECT_EQ(scale.encode(scale.decode(c)), c);
    if (code > 0) {
      EXPECT_GT(scale.decode(c), scale.decode(static_cast<std::uint8_t>(code - 1)));
    }
  }
}

TEST(ErrorScale, OfNoErrorAndBeyondTheScale) {
  const ErrorScale none(0);
  EXPECT_EQ(none.encode(0), 0);
  EXPECT_EQ(none.decode(63), 0);
  const ErrorScale scale(2);
  EXPECT_EQ(scale.encode(3), 63);
  EXPECT_EQ(scale.encode(std::numeric_limits<double>::infinity()), 63);
  EXPECT_EQ(scale.encode(std::numeric_limits<double>::quiet_NaN()), 63);
}

}  // namespace
}  // namespace adamas
