#include <gtest/gtest.h>

#include <random>

#include "core/base/error.h"
#include "isosurface/compression/entropy/prefix_code.h"

namespace adamas {

using namespace isosurface;

namespace {

using Lengths = std::vector<std::uint8_t>;

std::vector<std::byte> written(const CanonicalHuffman& code) {
  std::vector<std::byte> bytes;
  BitWriter out(bytes);
  code.write(out);
  out.finish();
  return bytes;
}

Lengths random_lengths(std::mt19937_64& random) {
  std::vector<std::uint64_t> counts(1 + random() % 60);
  for (std::uint64_t& count : counts) count = random() % 3 == 0 ? 0 : random() >> (20 + random() % 44);
  return package_merge(counts, CanonicalHuffman::kMaxLength);
}

Lengths lengths_of(const CanonicalHuffman& code) {
  Lengths lengths;
  for (const auto& word : code.words()) lengths.push_back(word.length);
  return lengths;
}

/// Returns a word as a binary number, its first bit highest.
std::uint32_t number(CanonicalHuffman::Word word) {
  std::uint32_t result = 0;
  for (int b = 0; b < word.length; ++b) result = result << 1 | (word.bits >> b & 1u);
  return result;
}

std::string refusal(const Lengths& lengths) {
  try {
    const CanonicalHuffman code(lengths, "here");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(CanonicalHuffman, CountsUpThroughTheWords) {
  const CanonicalHuffman code(Lengths{3, 1, 0, 3, 2});
  const std::vector<std::uint32_t> expected{0b110, 0b0, 0, 0b111, 0b10};
  for (std::size_t symbol = 0; symbol < expected.size(); ++symbol) {
    EXPECT_EQ(number(code.words()[symbol]), expected[symbol]) << symbol;
  }
  EXPECT_EQ(code.words()[0].bits, 0b011);
}

TEST(CanonicalHuffman, MatchesItsWordsWhateverFollows) {
  std::mt19937_64 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const CanonicalHuffman code(random_lengths(random));
    for (std::size_t symbol = 0; symbol < code.words().size(); ++symbol) {
      const auto word = code.words()[symbol];
      if (word.length == 0) continue;
      const auto match = code.match(word.bits | random() << word.length);
      ASSERT_EQ(match.symbol, symbol);
      ASSERT_EQ(match.length, word.length);
    }
  }
}

TEST(CanonicalHuffman, HasNoMatchForStreamsThatBeginWithNoWord) {
  const CanonicalHuffman none(Lengths{0, 0});
  EXPECT_EQ(none.match(0).length, 0);
  EXPECT_EQ(none.match(~std::uint64_t{0}).length, 0);
  const CanonicalHuffman one(Lengths{0, 1});
  EXPECT_EQ(one.match(0).length, 1);
  EXPECT_EQ(one.match(0).symbol, 1);
  EXPECT_EQ(one.match(1).length, 0);
}

TEST(CanonicalHuffman, RefusesLengthsOfNoWholeCode) {
  EXPECT_EQ(refusal({1, 1, 1}), "here: expected lengths with a Kraft sum of 1, found 6144/4096");
  EXPECT_EQ(refusal({1, 2}), "here: expected lengths with a Kraft sum of 1, found 3072/4096");
  EXPECT_EQ(refusal({2}), "here: expected lengths with a Kraft sum of 1, found 1024/4096");
  EXPECT_EQ(refusal({1, 13}), "here: expected lengths up to 12, found 13");
  EXPECT_NE(refusal(Lengths(256, 1)), "");
  EXPECT_EQ(refusal({0, 1}), "");
  EXPECT_EQ(refusal({}), "");
}

TEST(CanonicalHuffman, IsReadAsItWasWritten) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const Lengths lengths = random_lengths(random);
    const auto bytes = written(CanonicalHuffman(lengths));
    BitReader in(bytes);
    const auto code = CanonicalHuffman::read(in, lengths.size(), "here");
    ASSERT_TRUE(in.at_end());
    ASSERT_EQ(lengths_of(code), lengths);
    ASSERT_EQ(written(code), bytes);
  }
}

TEST(CanonicalHuffman, WritesNothingOfWordsThatAreNotUsed) {
  EXPECT_EQ(written(CanonicalHuffman(Lengths(33, 0))), std::vector<std::byte>{std::byte{0}});
  EXPECT_EQ(written(CanonicalHuffman(Lengths{1, 2, 2, 0, 0, 0, 0, 0, 0})),
            (std::vector<std::byte>{std::byte{0x13}, std::byte{0x22}}));
}

TEST(CanonicalHuffman, ReadsNoOtherBytes) {
  const auto error_of = [](const std::vector<Lengths::value_type>& nibbles, std::size_t symbols) {
    std::vector<std::byte> bytes;
    BitWriter out(bytes);
    for (const auto nibble : nibbles) out.put(nibble, 4);
    out.finish();
    try {
      BitReader in(bytes);
      static_cast<void>(CanonicalHuffman::read(in, symbols, "here"));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(error_of({3, 1, 2, 2}, 8), "");
  EXPECT_EQ(error_of({9}, 8), "here: expected at most 8 lengths, found 9");
  EXPECT_EQ(error_of({3, 1, 1, 0}, 8), "here: expected a last length above 0, found 0");
  EXPECT_EQ(error_of({3, 1}, 8), "here: expected 3 lengths, found the end of the data");
  EXPECT_EQ(error_of({}, 8), "here: expected 0 lengths, found the end of the data");
  EXPECT_EQ(error_of({2, 1, 15}, 8), "here: expected lengths up to 12, found 15");
}

}  // namespace
}  // namespace adamas
