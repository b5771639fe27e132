#include "core/base/disjoint_sets.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace adamas {
namespace {

/// The sets are compared with labels that are spread by brute force.
TEST(DisjointSets, TheLowestMemberStandsForEach) {
  std::mt19937 random(4);
  for (const std::uint32_t count : {1u, 2u, 30u, 300u}) {
    DisjointSets sets(count);
    std::vector<std::uint32_t> labels(count);
    for (std::uint32_t n = 0; n < count; ++n) labels[n] = n;
    for (std::uint32_t n = 0; n < 2 * count / 3; ++n) {
      const auto a = static_cast<std::uint32_t>(random() % count),
                 b = static_cast<std::uint32_t>(random() % count);
      sets.join(a, b);
      const std::uint32_t low = std::min(labels[a], labels[b]), high = std::max(labels[a], labels[b]);
      for (std::uint32_t& label : labels) label = label == high ? low : label;
      for (std::uint32_t m = 0; m < count; m += 7) EXPECT_EQ(sets.find(m), labels[m]);
    }
    EXPECT_EQ(std::move(sets).roots(), labels);
  }
}

}  // namespace
}  // namespace adamas
