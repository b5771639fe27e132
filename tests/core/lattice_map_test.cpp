#include "core/lattice/lattice_map.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace adamas {
namespace {

template <class Table>
void expect_agreement_with_an_ordered_map() {
  std::mt19937 random(7);
  Table table;
  table.reserve(500);
  std::map<LatticePoint, int> expected;
  for (int step = 0; step < 200000; ++step) {
    // There are few distinct points at several scales, so that they collide and return. Towards the end fewer
    // and fewer are kept.
    const int shift = static_cast<int>(random() % 3) * 10;
    const auto coordinate = [&] { return static_cast<std::int32_t>(random() % 11) << shift; };
    const LatticePoint p{coordinate(), coordinate(), coordinate()};
    if (random() % 100 < (step < 100000 ? 60u : 30u)) {
      const auto [value, is_new] = table.insert(p);
      ASSERT_EQ(is_new, expected.find(p) == expected.end());
      *value = expected[p] = step;
    } else {
      ASSERT_EQ(table.erase(p), expected.erase(p) == 1);
    }
    ASSERT_EQ(table.size(), expected.size());
    const LatticePoint q{coordinate(), coordinate(), coordinate()};
    const int* found = table.find(q);
    const auto wanted = expected.find(q);
    ASSERT_EQ(found != nullptr, wanted != expected.end());
    if (found != nullptr) {
      ASSERT_EQ(*found, wanted->second);
    }
  }
  std::map<LatticePoint, int> listed;
  table.for_each([&](LatticePoint p, int value) { EXPECT_TRUE(listed.emplace(p, value).second); });
  EXPECT_EQ(listed, expected);
}

TEST(LatticeMap, AgreesWithAnOrderedMapUnderRandomInsertionsAndRemovals) {
  expect_agreement_with_an_ordered_map<LatticeMap<int>>();
  expect_agreement_with_an_ordered_map<LatticeMap<int, LatticePoint, true>>();
}

TEST(LatticeMap, IsCompactWhereAsked) {
  LatticeMap<int, LatticePoint, true> table;
  const std::size_t entry = sizeof(LatticePoint) + sizeof(int);
  for (std::int32_t n = 0; n < 10000; ++n) {
    *table.insert({n, 3, 1 << 20}).first = n;
    if (n < 100) continue;
    ASSERT_LE(table.bytes(), entry * table.size() * 15 / 7 + 2 * entry);
    ASSERT_GE(table.bytes(), entry * table.size() * 10 / 7);
  }
}

TEST(LatticeMap, NewEntriesHaveDefaultValues) {
  LatticeMap<int> table;
  *table.insert({1, 2, 3}).first = 5;
  table.erase({1, 2, 3});
  EXPECT_EQ(*table.insert({1, 2, 3}).first, 0);
}

}  // namespace
}  // namespace adamas
