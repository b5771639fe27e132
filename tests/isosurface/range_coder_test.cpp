#include "isosurface/compression/range_coder.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <vector>

namespace adamas {
namespace {

constexpr std::size_t kGroups = 5, kSymbols = 20;

RangeTables some_tables(std::mt19937& random) {
  std::vector<SymbolFrequencies> groups;
  for (std::size_t g = 0; g < kGroups; ++g) {
    std::vector<std::uint64_t> counts(kSymbols, 0);
    for (std::uint64_t& count : counts) count = random() % 4 == 0 ? 0 : 1u << random() % (4 * g + 1);
    groups.emplace_back(counts);
  }
  return RangeTables(groups);
}

/// A sequence as it lies in memory for a decoder.
struct Coded {
  std::vector<std::uint8_t> groups, symbols;
  RangeTables::States states{};
  std::vector<std::byte> bytes;

  Coded(const RangeTables& tables, std::size_t count, std::mt19937& random) {
    for (std::size_t n = 0; n < count; ++n) {
      groups.push_back(static_cast<std::uint8_t>(random() % kGroups));
      // The escape, which is after all others, is there in each group.
      const std::size_t symbol = random() % (kSymbols + 1);
      symbols.push_back(static_cast<std::uint8_t>(tables.has(groups[n], symbol) ? symbol : kSymbols));
    }
    std::vector<std::uint16_t> words(count + 1);
    const std::uint16_t* const end = tables.encode(groups, symbols.data(), states, words.data());
    bytes.resize(RangeDecoder::kSlack);
    for (const std::uint16_t* word = words.data(); word != end; ++word) {
      bytes.push_back(static_cast<std::byte>(*word & 0xff));
      bytes.push_back(static_cast<std::byte>(*word >> 8));
    }
  }
  [[nodiscard]] RangeDecoder decoder(const RangeTables& tables) const {
    return {tables, states, bytes.data() + RangeDecoder::kSlack, bytes.data() + bytes.size()};
  }
};

/// Decodes in parts of at most so many symbols: of fewer than there are states each is taken by itself.
std::vector<std::uint8_t> decoded(const RangeTables& tables, const Coded& coded, std::size_t part) {
  RangeDecoder decoder = coded.decoder(tables);
  std::vector<std::uint8_t> symbols(coded.groups.size());
  for (std::size_t n = 0; n < symbols.size(); n += part) {
    const std::size_t count = std::min(part, symbols.size() - n);
    EXPECT_TRUE(decoder.take(std::span(coded.groups).subspan(n, count), symbols.data() + n));
  }
  EXPECT_TRUE(decoder.at_start());
  EXPECT_EQ(decoder.words(), coded.bytes.data() + RangeDecoder::kSlack);
  return symbols;
}

TEST(RangeCoder, GivesBackAllSymbols) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 30; ++trial) {
    const RangeTables tables = some_tables(random);
    for (const std::size_t count : {0u, 1u, 15u, 16u, 17u, 100u, 512u, 4096u}) {
      const Coded coded(tables, count, random);
      for (const std::size_t part :
           {std::size_t{1}, std::size_t{15}, std::size_t{16}, std::size_t{33}, std::size_t{4096}})
        EXPECT_EQ(decoded(tables, coded, part), coded.symbols) << count << " in parts of " << part;
    }
  }
}

TEST(RangeCoder, EndsWhereWordsAreMissing) {
  std::mt19937 random(9);
  const RangeTables tables = some_tables(random);
  const Coded coded(tables, 4096, random);
  const std::byte* const begin = coded.bytes.data() + RangeDecoder::kSlack;
  const std::byte* const end = coded.bytes.data() + coded.bytes.size();
  std::vector<std::uint8_t> symbols(coded.groups.size());
  for (std::ptrdiff_t missing = 2; missing < end - begin; missing += 62) {
    RangeDecoder decoder(tables, coded.states, begin + missing, end);
    const bool good = decoder.take(coded.groups, symbols.data());
    EXPECT_FALSE(good && decoder.at_start()) << missing;
  }
}

}  // namespace
}  // namespace adamas
