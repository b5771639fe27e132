#include "core/base/hash.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <random>
#include <set>

#include "tests/support/mesh_laws.h"

namespace adamas {
namespace {

/// The values that are published with the generator.
TEST(Hash, SplitMix64IsTheOneOfTheLiterature) {
  std::uint64_t state = 1234567;
  for (const std::uint64_t wanted : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                     4593380528125082431u, 16408922859458223821u}) {
    EXPECT_EQ(next_splitmix64(state), wanted);
  }
}

/// Flipping any bit of the argument flips half of the bits of the value, on average.
TEST(Hash, MixersSpreadEveryBit) {
  std::mt19937_64 random(5);
  for (const auto mix : {mix64, test::mix64_variant1}) {
    for (int bit = 0; bit < 64; ++bit) {
      int flipped = 0;
      constexpr int kTrials = 400;
      for (int i = 0; i < kTrials; ++i) {
        const std::uint64_t x = random();
        flipped += std::popcount(mix(x) ^ mix(x ^ std::uint64_t{1} << bit));
      }
      EXPECT_NEAR(flipped / double{kTrials}, 32, 2) << bit;
    }
  }
}

/// Any 2^k successive numbers, whose step is not a power of two, are spread over slots evenly.
TEST(Hash, FibonacciSlotsAreEven) {
  for (const std::uint64_t step : {1u, 3u, 10u, 1000u}) {
    std::array<int, 64> count{};
    for (std::uint64_t i = 0; i < 6400; ++i) ++count[fibonacci_slot(i * step, 6)];
    for (const int n : count) EXPECT_NEAR(n, 100, 50) << step;
  }
}

TEST(Hash, EdgesAreOneInBothDirections) {
  std::set<std::uint64_t> keys;
  for (std::uint32_t a = 0; a < 30; ++a) {
    for (std::uint32_t b = 0; b < a; ++b) {
      EXPECT_EQ(edge_key(a, b), edge_key(b, a));
      keys.insert(edge_key(a, b));
    }
  }
  EXPECT_EQ(keys.size(), 30u * 29 / 2);
}

}  // namespace
}  // namespace adamas
