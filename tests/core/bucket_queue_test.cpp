#include "tests/support/bucket_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

namespace adamas {
namespace {

TEST(BucketQueue, IsASortedMap) {
  std::mt19937 random(2);
  test::BucketQueue queue(20);
  std::map<LatticePoint, std::size_t> expected;
  for (int n = 0; n < 20'000; ++n) {
    const LatticePoint p{static_cast<std::int32_t>(random() % 5), static_cast<std::int32_t>(random() % 5), 0};
    if (random() % 3 == 0) {
      queue.erase(p);
      expected.erase(p);
    } else {
      queue.put(p, expected[p] = random() % 20);
    }
    if (n % 5000 == 4999) {
      queue.clear();
      expected.clear();
    }
    ASSERT_EQ(queue.size(), expected.size());
    ASSERT_EQ(queue.has(p), expected.contains(p));
    if (expected.empty()) continue;
    const auto by_bucket = [](const auto& a, const auto& b) { return a.second < b.second; };
    const auto [least, greatest] = std::minmax_element(expected.begin(), expected.end(), by_bucket);
    ASSERT_EQ(queue.least(), least->second);
    ASSERT_EQ(queue.greatest(), greatest->second);
    for (const std::size_t bucket : {least->second, greatest->second}) {
      const auto count = std::count_if(expected.begin(), expected.end(),
                                       [&](const auto& entry) { return entry.second == bucket; });
      ASSERT_EQ(queue.bucket(bucket).size(), static_cast<std::size_t>(count));
      for (const LatticePoint q : queue.bucket(bucket)) ASSERT_EQ(expected.at(q), bucket);
    }
  }
}

}  // namespace
}  // namespace adamas
