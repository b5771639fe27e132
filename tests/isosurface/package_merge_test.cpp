#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <random>

#include "isosurface/compression/entropy/prefix_code.h"

namespace adamas {

using namespace isosurface;

namespace {

using Counts = std::vector<std::uint64_t>;
using Lengths = std::vector<std::uint8_t>;

std::uint64_t cost(const Counts& counts, const Lengths& lengths) {
  std::uint64_t sum = 0;
  for (std::size_t s = 0; s < counts.size(); ++s) sum += counts[s] * lengths[s];
  return sum;
}

/// Expects words of at most `limit` bits for the symbols that occur, none for the others, and a complete
/// prefix code.
void expect_code(const Counts& counts, const Lengths& lengths, int limit) {
  ASSERT_EQ(lengths.size(), counts.size());
  std::uint64_t sum = 0, used = 0;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    ASSERT_EQ(lengths[s] > 0, counts[s] > 0);
    ASSERT_LE(lengths[s], limit);
    if (lengths[s] > 0) sum += std::uint64_t{1} << (limit - lengths[s]);
    used += counts[s] > 0;
  }
  if (used > 1) {
    ASSERT_EQ(sum, std::uint64_t{1} << limit);
  }
}

/// Returns the least cost over all lengths from 1 to the limit whose Kraft sum is at most 1.
std::uint64_t least_cost_by_trying(const Counts& counts, int limit) {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  Lengths lengths(counts.size(), 0);
  const std::function<void(std::size_t, std::uint64_t)> assign = [&](std::size_t s, std::uint64_t room) {
    if (s == counts.size()) {
      least = std::min(least, cost(counts, lengths));
      return;
    }
    if (counts[s] == 0) return assign(s + 1, room);
    for (int length = 1; length <= limit; ++length) {
      const std::uint64_t share = std::uint64_t{1} << (limit - length);
      if (share > room) continue;
      lengths[s] = static_cast<std::uint8_t>(length);
      assign(s + 1, room - share);
    }
  };
  assign(0, std::uint64_t{1} << limit);
  return least;
}

/// Returns the least cost, found from the root of the tree downwards: at each level some of the most frequent
/// symbols left are leaves, and all others go one level deeper. The counts are in falling order.
std::uint64_t least_cost_by_levels(const Counts& counts, int limit) {
  constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();
  std::map<std::tuple<int, std::size_t, std::size_t>, std::uint64_t> known;
  const std::function<std::uint64_t(int, std::size_t, std::size_t)> least = [&](int level, std::size_t nodes,
                                                                                std::size_t placed) {
    const std::size_t left = counts.size() - placed;
    if (left == 0) return std::uint64_t{0};
    if (level == limit) return nodes >= left ? std::uint64_t{0} : kNone;
    nodes = std::min(nodes, left);
    const auto [at, fresh] = known.try_emplace({level, nodes, placed}, kNone);
    if (!fresh) return at->second;
    std::uint64_t best = kNone;
    for (std::size_t leaves = 0; leaves <= nodes; ++leaves) {
      std::uint64_t deeper = 0;
      for (std::size_t s = placed + leaves; s < counts.size(); ++s) deeper += counts[s];
      const std::uint64_t below = least(level + 1, 2 * (nodes - leaves), placed + leaves);
      if (below != kNone) best = std::min(best, deeper + below);
    }
    return known[{level, nodes, placed}] = best;
  };
  return least(0, 1, 0);
}

/// Returns the cost of Huffman's code, whose words may have any length: the sum of the weights of all inner
/// nodes.
std::uint64_t huffman_cost(const Counts& counts) {
  std::priority_queue<std::uint64_t, Counts, std::greater<>> weights;
  for (const std::uint64_t count : counts) {
    if (count > 0) weights.push(count);
  }
  std::uint64_t sum = 0;
  while (weights.size() > 1) {
    const std::uint64_t a = weights.top();
    weights.pop();
    const std::uint64_t pair = a + weights.top();
    weights.pop();
    sum += pair;
    weights.push(pair);
  }
  return sum;
}

Counts random_counts(std::mt19937_64& random, std::size_t symbols, bool zeros) {
  Counts counts(symbols);
  for (std::uint64_t& count : counts) {
    count = 1 + (random() >> (44 + random() % 20));
    if (zeros && random() % 4 == 0) count = 0;
  }
  return counts;
}

Counts fibonacci(std::size_t symbols) {
  Counts counts{1, 1};
  while (counts.size() < symbols) counts.push_back(counts[counts.size() - 1] + counts[counts.size() - 2]);
  return counts;
}

TEST(PackageMerge, IsTheBestOfAllLengthsOnSmallAlphabets) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 400; ++trial) {
    const int limit = 1 + trial % 5;
    const std::size_t most = std::min<std::size_t>(6, std::size_t{1} << limit);
    const Counts counts = random_counts(random, 2 + random() % (most - 1), trial % 2 == 0);
    const Lengths lengths = package_merge(counts, limit);
    expect_code(counts, lengths, limit);
    ASSERT_EQ(cost(counts, lengths), least_cost_by_trying(counts, limit)) << trial;
  }
}

TEST(PackageMerge, IsTheBestOfAllTreesWhereTheLimitBinds) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 60; ++trial) {
    Counts counts =
        trial % 3 == 0 ? fibonacci(4 + random() % 29) : random_counts(random, 17 + random() % 16, false);
    const int limit = 5 + trial % 4;
    const Lengths lengths = package_merge(counts, limit);
    expect_code(counts, lengths, limit);
    const std::uint64_t found = cost(counts, lengths);
    std::sort(counts.begin(), counts.end(), std::greater<>());
    ASSERT_EQ(found, least_cost_by_levels(counts, limit)) << trial;
  }
}

TEST(PackageMerge, IsHuffmansCodeWhereTheLimitDoesNotBind) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Counts counts = random_counts(random, 2 + random() % 31, true);
    if (counts.size() - static_cast<std::size_t>(std::count(counts.begin(), counts.end(), 0u)) < 2) continue;
    const Lengths lengths = package_merge(counts, 32);
    expect_code(counts, lengths, 32);
    ASSERT_EQ(cost(counts, lengths), huffman_cost(counts)) << trial;
  }
}

TEST(PackageMerge, LimitsTheLongWordsOfFibonacciCounts) {
  const Counts counts = fibonacci(33);
  const Lengths limited = package_merge(counts, 12), free = package_merge(counts, 32);
  expect_code(counts, limited, 12);
  EXPECT_EQ(*std::max_element(limited.begin(), limited.end()), 12);
  EXPECT_EQ(*std::max_element(free.begin(), free.end()), 32);
  EXPECT_EQ(cost(counts, free), huffman_cost(counts));
  EXPECT_GT(cost(counts, limited), cost(counts, free));
}

TEST(PackageMerge, NamesNoAndOneSymbol) {
  EXPECT_EQ(package_merge({}, 12), Lengths{});
  EXPECT_EQ(package_merge(Counts{0, 0, 0}, 12), (Lengths{0, 0, 0}));
  EXPECT_EQ(package_merge(Counts{0, 7, 0}, 12), (Lengths{0, 1, 0}));
  EXPECT_EQ(package_merge(Counts{7, 0, 1}, 1), (Lengths{1, 0, 1}));
}

TEST(PackageMerge, FillsTheLimit) {
  EXPECT_EQ(package_merge(Counts{1, 100, 10000, 1000000}, 2), (Lengths{2, 2, 2, 2}));
  EXPECT_EQ(package_merge(Counts(4096, 3), 12), Lengths(4096, 12));
}

TEST(PackageMerge, GivesTheLaterOfEqualCountsTheShorterWord) {
  EXPECT_EQ(package_merge(Counts{5, 5, 5}, 12), (Lengths{2, 2, 1}));
}

}  // namespace
}  // namespace adamas
