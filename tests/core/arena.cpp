#include "core/base/arena.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

namespace adamas {
namespace {

/// Fills an arena beyond its first blocks: objects stay where they are, and keep what they hold.
template <std::size_t Numbers>
void fill(std::size_t count) {
  using Object = std::array<std::uint32_t, Numbers>;
  Arena<Object> arena;
  std::vector<Object*> objects;
  for (std::uint32_t n = 0; n < count; ++n) {
    objects.push_back(arena.add());
    objects.back()->fill(n);
    ASSERT_EQ(arena.size(), n + 1);
  }
  for (std::uint32_t n = 0; n < count; ++n) {
    ASSERT_EQ(objects[n], &arena[n]);
    ASSERT_EQ(objects[n]->front(), n);
    ASSERT_EQ(objects[n]->back(), n);
  }
}

TEST(Arena, KeepsWhatIsPutIntoIt) {
  fill<1>(2'000'000);
  fill<64>(40'000);
  fill<5000>(700);     // of which the first block has three
  fill<200'000>(20);   // each greater than the first block
  fill<1'000'000>(3);  // and than a large page
}

}  // namespace
}  // namespace adamas
