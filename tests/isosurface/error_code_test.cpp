#include "isosurface/preprocessing/error_code.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "isosurface/volume/error_scale.h"

namespace adamas {

using namespace isosurface;

namespace {

TEST(ErrorCode, IsThatOfTheScale) {
  const ErrorScale scale(3.5);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-20, 0);
  for (int trial = 0; trial < 20000; ++trial) {
    const double ratio = std::exp2(exponent(random));
    const std::uint8_t least = scale.encode(3.5 * ratio), most = scale.encode(3.5 * ratio * (1 + 1e-6));
    for (const int code : {error_code(ratio * ratio), error_code(static_cast<float>(ratio * ratio))}) {
      ASSERT_GE(code, least) << ratio;
      ASSERT_LE(code, most) << ratio;
    }
  }
}

TEST(ErrorCode, OfExtremes) {
  EXPECT_EQ(error_code(0.0), 0);
  EXPECT_EQ(error_code(0.0f), 0);
  EXPECT_EQ(error_code(1e-300), 1);
  EXPECT_EQ(error_code(1e-38f), 1);
  EXPECT_EQ(error_code(1.0), 63);
  EXPECT_EQ(error_code(std::numeric_limits<float>::infinity()), 63);
  EXPECT_EQ(error_code(std::numeric_limits<double>::infinity()), 63);
}

TEST(ErrorCode, OfACoarserLodIsThatOfTheSameError) {
  const ErrorScale fine(0.7);
  for (int lods = 0; lods < 4; ++lods) {
    const ErrorScale coarse(std::ldexp(0.7, lods));
    for (int code = 0; code < ErrorScale::kCodes; ++code) {
      const auto c = static_cast<std::uint8_t>(code);
      EXPECT_EQ(coarser_code(c, lods), coarse.encode(fine.decode(c)));
    }
  }
}

}  // namespace
}  // namespace adamas
