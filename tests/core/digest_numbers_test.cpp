#include "core/base/digest_numbers.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "core/base/hash.h"
#include "core/base/parallel.h"

namespace adamas {
namespace {

Digest digest_of(std::uint64_t value) { return {mix64(value), mix64(~value)}; }

/// Few and many digests, of which many are equal, are added in turn; a map numbers them one after another.
TEST(DigestNumbers, FollowTheOrderInWhichDigestsComeFirst) {
  std::mt19937_64 random(7);
  DigestNumbers numbers;
  std::map<std::uint64_t, std::uint32_t> expected;
  for (const std::size_t count : {0u, 100u, 50'000u, 3u, 120'000u, 4096u}) {
    std::vector<std::uint64_t> values(count);
    for (std::uint64_t& value : values) value = random() % 60'000;
    std::vector<Digest> digests;
    for (const std::uint64_t value : values) digests.push_back(digest_of(value));
    const DigestNumbers::Added added = numbers.add(digests);
    std::vector<std::uint32_t> wanted, firsts;
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto [at, fresh] = expected.try_emplace(values[i], static_cast<std::uint32_t>(expected.size()));
      wanted.push_back(at->second);
      if (fresh) firsts.push_back(i);
    }
    ASSERT_EQ(added.numbers, wanted);
    ASSERT_EQ(added.firsts, firsts);
    ASSERT_EQ(numbers.size(), expected.size());
  }
  const std::vector<Digest> by_number = numbers.digests();
  for (const auto& [value, number] : expected) {
    ASSERT_EQ(numbers.find(digest_of(value)), number);
    ASSERT_EQ(by_number[number], digest_of(value));
  }
  EXPECT_FALSE(numbers.find(digest_of(60'001)));
}

}  // namespace
}  // namespace adamas
