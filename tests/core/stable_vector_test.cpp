#include "core/base/stable_vector.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <set>
#include <thread>
#include <vector>

namespace adamas {
namespace {

/// Fills a vector beyond its first blocks, and expects that objects stay where they are and keep their
/// contents.
template <std::size_t Numbers>
void fill(std::size_t count) {
  using Object = std::array<std::uint32_t, Numbers>;
  StableVector<Object> vector;
  std::vector<Object*> objects;
  for (std::uint32_t n = 0; n < count; ++n) {
    objects.push_back(vector.add());
    objects.back()->fill(n);
    ASSERT_EQ(vector.size(), n + 1);
  }
  for (std::uint32_t n = 0; n < count; ++n) {
    ASSERT_EQ(objects[n], &vector[n]);
    ASSERT_EQ(objects[n]->front(), n);
    ASSERT_EQ(objects[n]->back(), n);
  }
}

TEST(StableVector, KeepsWhatIsPutIntoIt) {
  fill<1>(2'000'000);
  fill<64>(40'000);
  fill<5000>(700);    // the first block holds three of these
  fill<200'000>(20);  // each is greater than the first block
}

TEST(LargeBlocks, AreTakenAgainByOthers) {
  std::vector<std::byte*> taken;
  std::set<std::byte*> different;
  for (int n = 0; n < 40; ++n) {
    taken.push_back(take_large_block());
    std::memset(taken.back(), n, kLargePage);
    ASSERT_EQ(reinterpret_cast<std::uintptr_t>(taken.back()) % kLargePage, 0u);
    ASSERT_TRUE(different.insert(taken.back()).second);
  }
  for (int n = 0; n < 40; ++n) ASSERT_EQ(static_cast<int>(taken[static_cast<std::size_t>(n)][12345]), n);
  for (std::byte* const block : taken) give_large_block(block);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([t] {
      for (int n = 0; n < 100; ++n) {
        std::byte* const mine = take_large_block();
        std::memset(mine, t, 1000);
        for (int at = 0; at < 1000; ++at) ASSERT_EQ(static_cast<int>(mine[at]), t);
        give_large_block(mine);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace adamas
