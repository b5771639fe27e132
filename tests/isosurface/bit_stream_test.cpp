#include "isosurface/compression/entropy/bit_stream.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>

namespace adamas {

using namespace isosurface;

namespace {

using Bytes = std::vector<std::byte>;
/// A value and how many bits it has.
using Number = std::pair<std::uint64_t, int>;

std::vector<Number> random_numbers(std::mt19937_64& random, std::size_t count, int most_bits) {
  std::vector<Number> numbers;
  for (std::size_t n = 0; n < count; ++n) {
    const int bits = static_cast<int>(random() % static_cast<unsigned>(most_bits + 1));
    numbers.emplace_back(random() & ((std::uint64_t{1} << bits) - 1), bits);
  }
  return numbers;
}

Bytes written(const std::vector<Number>& numbers) {
  Bytes bytes;
  BitWriter out(bytes);
  for (const auto& [value, bits] : numbers) out.put(value, bits);
  out.finish();
  return bytes;
}

TEST(BitStream, ReadsWhatWasWritten) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const auto numbers = random_numbers(random, random() % 60, BitReader::kRefilled);
    const Bytes bytes = written(numbers);
    std::size_t bits = 0;
    BitReader in(bytes);
    for (const auto& [value, length] : numbers) {
      in.refill();
      ASSERT_EQ(in.take(length), value);
      bits += static_cast<std::size_t>(length);
    }
    EXPECT_EQ(bytes.size(), (bits + 7) / 8);
    EXPECT_FALSE(in.overrun());
    EXPECT_TRUE(in.at_end());
  }
}

TEST(BitStream, PutsTheLeastBitFirst) {
  EXPECT_EQ(written({{1, 1}, {0, 2}, {3, 2}, {0x1fe, 9}}),
            (Bytes{std::byte{0b11011001}, std::byte{0b00111111}}));
  EXPECT_EQ(written({{(std::uint64_t{1} << 63) - 1, 63}, {2, 2}}),
            (Bytes{std::byte{255}, std::byte{255}, std::byte{255}, std::byte{255}, std::byte{255},
                   std::byte{255}, std::byte{255}, std::byte{127}, std::byte{1}}));
  EXPECT_TRUE(written({}).empty());
}

TEST(BitStream, SeesEveryReadPastTheEnd) {
  std::mt19937_64 random(2);
  for (std::size_t size = 0; size <= 40; ++size) {
    const Bytes bytes(size, std::byte{0xff});
    for (int trial = 0; trial < 50; ++trial) {
      BitReader in(bytes);
      for (std::size_t taken = 0; taken <= 8 * size + 500;) {
        ASSERT_EQ(in.overrun(), taken > 8 * size);
        ASSERT_EQ(in.at_end(), taken == 8 * size);
        const int count = static_cast<int>(random() % 57);
        in.refill();
        const std::uint64_t bits = in.take(count);
        const std::size_t real =
            std::min<std::size_t>(8 * size - std::min(taken, 8 * size), static_cast<std::size_t>(count));
        ASSERT_EQ(bits, (std::uint64_t{1} << real) - 1);
        taken += static_cast<std::size_t>(count);
      }
    }
  }
}

TEST(BitStream, TellsTheFillOfTheLastByteFromMoreData) {
  for (const auto& [last, whole] : {std::pair{0b00000101, true}, {0b00001101, false}, {0b10000101, false}}) {
    const Bytes bytes{static_cast<std::byte>(last)};
    BitReader in(bytes);
    in.refill();
    EXPECT_EQ(in.take(3), 5u);
    EXPECT_EQ(in.at_end(), whole);
  }
  const Bytes longer{std::byte{5}, std::byte{0}};
  BitReader in(longer);
  in.refill();
  EXPECT_EQ(in.take(3), 5u);
  EXPECT_FALSE(in.at_end());
  EXPECT_FALSE(in.overrun());
}

}  // namespace
}  // namespace adamas
