#include <gtest/gtest.h>

#include <array>
#include <map>
#include <random>

#include "core/lattice/point_numbers.h"

namespace adamas {
namespace {

/// The points have all levels, are dense in some places and scattered in others, and include the domain's
/// corners.
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

/// Each table finds its own points, and no others.
TEST(PointNumbers, InTwoTables) {
  std::mt19937 random(5);
  std::array<PointNumbers, 2> tables;
  std::array<std::map<LatticePoint, std::uint32_t>, 2> expected;
  for (int turn = 0; turn < 4000; ++turn) {
    const std::size_t which = random() % 2;
    const auto level = static_cast<int>(random() % 3);
    const auto coordinate = [&] { return static_cast<std::int32_t>(random() % 20) << level; };
    const LatticePoint p{coordinate(), coordinate(), coordinate()};
    const auto number = static_cast<std::uint32_t>(expected[which].size());
    if (expected[which].try_emplace(p, number).second) *tables[which].insert(p).first = number;
  }
  std::map<std::uint32_t, std::uint32_t> common, wanted;
  tables[0].for_each_common(tables[1], [&](std::uint32_t here, std::uint32_t there) {
    EXPECT_TRUE(common.emplace(here, there).second);
  });
  for (const auto& [p, number] : expected[0]) {
    const auto found = expected[1].find(p);
    if (found != expected[1].end()) wanted.emplace(number, found->second);
  }
  EXPECT_EQ(common, wanted);
  EXPECT_GT(common.size(), 100u);
  EXPECT_LT(common.size(), expected[0].size());
}

}  // namespace
}  // namespace adamas
