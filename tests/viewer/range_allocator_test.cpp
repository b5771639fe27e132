#include "viewer/gl/range_allocator.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace adamas {

using namespace viewer;

namespace {

TEST(RangeAllocator, PartsNeverOverlapAndAllComesBack) {
  constexpr std::size_t kSize = 500;
  std::mt19937 random(7);
  RangeAllocator ranges(kSize);
  std::vector<char> taken(kSize, 0);
  std::vector<std::pair<std::size_t, std::size_t>> parts;
  std::size_t sum = 0;
  for (int step = 0; step < 20'000; ++step) {
    if (parts.empty() || random() % 2 == 0) {
      const std::size_t count = random() % 40;
      const auto first = ranges.take(count);
      if (!first) {
        // No free run is that long.
        std::size_t run = 0, longest = 0;
        for (const char each : taken) longest = std::max(longest, run = each != 0 ? 0 : run + 1);
        ASSERT_LT(longest, count);
        continue;
      }
      if (count == 0) continue;
      ASSERT_LE(*first + count, kSize);
      for (std::size_t n = *first; n < *first + count; ++n) ASSERT_EQ(std::exchange(taken[n], 1), 0);
      parts.emplace_back(*first, count);
      sum += count;
    } else {
      const std::size_t which = random() % parts.size();
      const auto [first, count] = parts[which];
      ranges.give_back(first, count);
      for (std::size_t n = first; n < first + count; ++n) taken[n] = 0;
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(which));
      sum -= count;
    }
    ASSERT_EQ(ranges.free_size(), kSize - sum);
  }
  for (const auto& [first, count] : parts) ranges.give_back(first, count);
  EXPECT_EQ(ranges.take(kSize), 0u) << "in one piece again";
}

}  // namespace
}  // namespace adamas
