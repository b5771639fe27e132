#include <gtest/gtest.h>

#include <map>
#include <random>

#include "core/lattice/point_numbers.h"

namespace adamas {
namespace {

/// Points of all levels, dense in some places and scattered, with the domain's corners.
TEST(PointNumbers, AreThoseOfAMap) {
  std::mt19937 random(3);
  PointNumbers numbers;
  std::map<LatticePoint, std::uint32_t> expected;
  const auto try_one = [&](LatticePoint p) {
    const auto [number, is_new] = numbers.insert(p);
    const auto [known, is_first] = expected.try_emplace(p, static_cast<std::uint32_t>(expected.size()));
    ASSERT_EQ(is_new, is_first);
    if (is_new) {
      ASSERT_EQ(*number, PointNumbers::kNone);
      *number = known->second;
    }
    ASSERT_EQ(*number, known->second);
  };
  for (int turn = 0; turn < 60000; ++turn) {
    const int level = static_cast<int>(random() % (kRootBits + 1));
    const std::int32_t side = (64 << kRootBits >> level) + 1, near = std::min(side, 12);
    const auto coordinate = [&] {
      const auto x = static_cast<std::int32_t>(random() % static_cast<unsigned>(turn % 3 == 0 ? side : near));
      return x << level;
    };
    try_one({coordinate(), coordinate(), coordinate()});
    if (HasFatalFailure()) return;
  }
  try_one({0, 0, 0});
  try_one({64 << kRootBits, 64 << kRootBits, 64 << kRootBits});
  EXPECT_GT(expected.size(), 10000u);
}

}  // namespace
}  // namespace adamas
