#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>

#include "core/geometry/determinant_sign.h"

namespace adamas {
namespace {

/// Returns the sign of the sum over all permutations, in integers of 128 bits.
int sign_in_integers(const SmallMatrix& matrix, std::size_t n) {
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  __extension__ __int128 sum = 0;
  do {
    __extension__ __int128 product = 1;
    for (std::size_t r = 0; r < n; ++r) product *= static_cast<std::int64_t>(matrix[r][order[r]]);
    std::size_t inversions = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j) inversions += order[j] > order[i] ? 1 : 0;
    }
    sum += inversions % 2 == 0 ? product : -product;
  } while (std::next_permutation(order.begin(), order.end()));
  return sum > 0 ? 1 : sum < 0 ? -1 : 0;
}

TEST(DeterminantSign, IsThatOfIntegersAlsoWhereNearlySingular) {
  std::mt19937_64 random(1);
  std::size_t zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::size_t n = 2 + random() % 4;
    // Entries have 23 bits, so products of five fit into 128 bits, but not into a double.
    const auto entry = [&] {
      return static_cast<double>(static_cast<std::int64_t>(random() % (1u << 24)) - (1 << 23));
    };
    SmallMatrix matrix{};
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c) matrix[r][c] = entry();
    }
    if (i % 2 == 0) {
      // The last row is a combination of two others, sometimes changed by one unit.
      for (std::size_t c = 0; c < n; ++c)
        matrix[n - 1][c] = n == 2 ? matrix[0][c] : matrix[0][c] - (n > 2 ? matrix[n - 2][c] : 0);
      if (i % 4 == 0) matrix[n - 1][random() % n] += 1;
    }
    if (i % 3 == 0) {
      for (std::size_t r = 0; r < n; ++r) matrix[r][n - 1] = random() % 4 == 0 ? 0 : 1;
    }
    // Columns are scaled by powers of two, which changes no sign.
    SmallMatrix scaled = matrix;
    for (std::size_t c = 0; c < n; ++c) {
      // The products of some of these are beyond the range of doubles.
      const int exponent = (i % 5 == 0 ? 20 : 1) * (static_cast<int>(random() % 80) - 40);
      for (std::size_t r = 0; r < n; ++r) scaled[r][c] = std::ldexp(matrix[r][c], exponent);
    }
    const int expected = sign_in_integers(matrix, n);
    zeros += expected == 0 ? 1 : 0;
    ASSERT_EQ(determinant_sign(matrix, n), expected) << i;
    ASSERT_EQ(determinant_sign(scaled, n), expected) << i;
    // Entries whose exponents differ by more than a double's precision cannot be subtracted exactly.
    SmallMatrix wide = matrix;
    for (std::size_t c = 0; c < n; ++c) wide[0][c] = std::ldexp(wide[0][c], c + 1 == n ? 0 : 40);
    if (wide[0][n - 1] == 0) {
      ASSERT_EQ(determinant_sign(wide, n), expected) << i;
    }
    const auto value = static_cast<double>(determinant_value(matrix, n));
    ASSERT_EQ(value > 0 ? 1 : value < 0 ? -1 : 0, expected) << i;
    // Integers up to 2^53 have almost no relative error.
    if (std::abs(value) < 1e15) {
      ASSERT_NEAR(value, std::round(value), 1e-12 * std::abs(value)) << i;
    }
  }
  EXPECT_GT(zeros, 1000u);
}

TEST(DeterminantSign, OfManyBitsIsThatOfTheValue) {
  std::mt19937_64 random(2);
  std::size_t zeros = 0, negative = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::size_t n = 2 + random() % 3;
    // Numbers of more than 49 bits are too long for whole numbers of 256 bits.
    const std::uint64_t bits = 36 + random() % 17;
    SmallMatrix matrix{};
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c < n; ++c)
        matrix[r][c] = static_cast<double>(random() >> (64 - bits)) * (random() % 2 == 0 ? -1 : 1);
    }
    // The last row is the difference of two others, or the other one, but for one unit in half of the cases.
    for (std::size_t c = 0; c < n; ++c) matrix[n - 1][c] = matrix[0][c] - (n > 2 ? matrix[1][c] : 0);
    if (i % 2 == 0) matrix[n - 1][random() % n] += random() % 2 == 0 ? -1 : 1;
    const long double value = determinant_value(matrix, n);
    ASSERT_EQ(determinant_sign(matrix, n), value > 0 ? 1 : value < 0 ? -1 : 0) << i;
    zeros += value == 0 ? 1 : 0;
    negative += value < 0 ? 1 : 0;
  }
  EXPECT_GT(zeros, 8000u);
  EXPECT_GT(negative, 3000u);
}

}  // namespace
}  // namespace adamas
