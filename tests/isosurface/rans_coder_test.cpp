#include "isosurface/compression/entropy/rans_coder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "core/base/error.h"

namespace adamas {

using namespace isosurface;

namespace {

constexpr std::size_t kContexts = 9, kSymbols = 20;

/// Returns counts of contexts: some are similar, some have few symbols, and one never occurs.
ContextCounts some_counts(std::mt19937& random) {
  ContextCounts counts(kContexts, kSymbols);
  for (std::size_t context = 0; context < kContexts; ++context) {
    if (context == 4) continue;
    for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
      const std::size_t often = random() % 4 == 0 ? 0 : 1u << random() % (context + 1);
      for (std::size_t n = 0; n < often; ++n) counts.add(context, symbol);
    }
  }
  return counts;
}

ContextTables written_and_read(const ContextTables& tables) {
  std::vector<std::byte> bytes;
  BitWriter out(bytes);
  tables.write(out);
  out.finish();
  BitReader in(bytes);
  ContextTables read = ContextTables::read(in, tables.contexts(), tables.symbols(), "tables");
  EXPECT_TRUE(in.at_end());
  return read;
}

TEST(ContextTables, AreReadAsTheyWereWritten) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const ContextTables tables(some_counts(random));
    const ContextTables read = written_and_read(tables);
    EXPECT_TRUE(std::ranges::equal(tables.tables_of_contexts(), read.tables_of_contexts()));
    EXPECT_EQ(tables.tables(), read.tables());
    for (const auto& table : tables.tables()) {
      EXPECT_EQ(table.size(), kSymbols + 1);
      EXPECT_GT(table.back(), 0);
      EXPECT_EQ(std::accumulate(table.begin(), table.end(), 0u), ContextTables::kScale);
    }
  }
}

TEST(ContextTables, OfNothingAreOneTable) {
  const ContextTables tables{ContextCounts(kContexts, kSymbols)};
  EXPECT_EQ(tables.tables().size(), 1u);
  EXPECT_EQ(written_and_read(tables).tables(), tables.tables());
}

TEST(ContextTables, AreSharedByContextsThatAreAlikeAndNotByOthers) {
  ContextCounts counts(4, 2);
  for (int n = 0; n < 1000; ++n) {
    for (const std::size_t context : {0u, 3u}) counts.add(context, n % 10 == 0 ? 1 : 0);
    for (const std::size_t context : {1u, 2u}) counts.add(context, n % 10 == 0 ? 0 : 1);
  }
  const ContextTables tables(counts);
  const auto of = tables.tables_of_contexts();
  EXPECT_EQ(std::vector<std::uint8_t>(of.begin(), of.end()), (std::vector<std::uint8_t>{0, 1, 1, 0}));
}

TEST(ContextTables, DamagedBitsAreRefusedOrReadAsOtherTables) {
  std::mt19937 random(5);
  const ContextTables tables(some_counts(random));
  std::vector<std::byte> bytes;
  BitWriter out(bytes);
  tables.write(out);
  out.finish();
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto damaged = bytes;
    damaged[bit / 8] ^= std::byte{1} << bit % 8;
    BitReader in(damaged);
    try {
      const ContextTables read = ContextTables::read(in, kContexts, kSymbols, "tables");
      if (!in.at_end()) continue;
      std::vector<std::byte> again;
      BitWriter writer(again);
      read.write(writer);
      writer.finish();
      EXPECT_EQ(again, damaged) << bit;
    } catch (const Error&) {
    }
  }
}

/// A sequence of symbols with plain bits after every seven of them.
struct Sequence {
  std::vector<std::uint8_t> tables, symbols;

  Sequence(const ContextTables& contexts, std::size_t count, std::mt19937& random) {
    for (std::size_t n = 0; n < count; ++n) {
      tables.push_back(contexts.tables_of_contexts()[random() % kContexts]);
      symbols.push_back(static_cast<std::uint8_t>(random() % kSymbols));
    }
  }
};

std::uint64_t plain(std::size_t n) { return n * 0x9e3779b97f4a7c15u >> (64 - n % 57) % 64; }

template <std::size_t kStates>
std::vector<std::byte> encoded(const RansTables& tables, const Sequence& sequence, std::size_t part,
                               std::span<const std::byte> along = {}) {
  RansEncoder<kStates> encoder(tables, sequence.symbols.size());
  for (std::size_t n = 0; n < sequence.symbols.size(); n += part) {
    const std::size_t count = std::min(part, sequence.symbols.size() - n);
    encoder.put(std::span(sequence.tables).subspan(n, count), std::span(sequence.symbols).subspan(n, count));
    if (n % 57 > 0) encoder.put_bits(plain(n), static_cast<int>(n % 57));
  }
  std::vector<std::byte> bytes;
  encoder.finish(bytes, along);
  return bytes;
}

/// Decodes the sequence, `part` symbols at a time. Returns whether all symbols are right.
template <std::size_t kStates>
bool takes(RansDecoder<kStates>& decoder, const Sequence& sequence, std::size_t part) {
  std::vector<std::uint8_t> symbols(sequence.symbols.size());
  for (std::size_t n = 0; n < symbols.size(); n += part) {
    const std::size_t count = std::min(part, symbols.size() - n);
    if (!decoder.take(std::span(sequence.tables).subspan(n, count), symbols.data() + n)) return false;
    if (decoder.bits().take(static_cast<int>(n % 57)) != (n % 57 > 0 ? plain(n) : 0)) return false;
  }
  return symbols == sequence.symbols;
}

/// Returns whether all symbols are decoded and the bytes end behind them.
template <std::size_t kStates>
bool finds(const RansTables& tables, const Sequence& sequence, std::size_t part,
           std::span<const std::byte> bytes) {
  RansDecoder<kStates> decoder(tables, bytes);
  return takes(decoder, sequence, part) && decoder.at_end();
}

template <class States>
class RansCoder : public testing::Test {};
using AllStates =
    testing::Types<std::integral_constant<std::size_t, 4>, std::integral_constant<std::size_t, 8>,
                   std::integral_constant<std::size_t, 16>>;
TYPED_TEST_SUITE(RansCoder, AllStates);

TYPED_TEST(RansCoder, GivesBackAllSymbolsAndBits) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 30; ++trial) {
    const ContextTables contexts(some_counts(random));
    const RansTables tables(contexts);
    for (const std::size_t count : {0u, 1u, 15u, 16u, 17u, 100u, 512u, 4096u}) {
      const Sequence sequence(contexts, count, random);
      for (const std::size_t part : {1u, 15u, 16u, 33u, 4096u}) {
        const auto bytes = encoded<TypeParam::value>(tables, sequence, part);
        EXPECT_TRUE(finds<TypeParam::value>(tables, sequence, part, bytes)) << count << " by " << part;
      }
    }
  }
}

TYPED_TEST(RansCoder, SeesThatBytesAreMissing) {
  std::mt19937 random(9);
  const ContextTables contexts(some_counts(random));
  const RansTables tables(contexts);
  const Sequence sequence(contexts, 4096, random);
  const auto bytes = encoded<TypeParam::value>(tables, sequence, 100);
  for (std::size_t size = 0; size < bytes.size(); size += 31)
    EXPECT_FALSE(finds<TypeParam::value>(tables, sequence, 100, std::span(bytes).first(size))) << size;
}

/// This is a law of the coder: symbols whose frequencies are those of the table take the table's entropy, and
/// little more.
TYPED_TEST(RansCoder, TakesTheEntropyOfTheTable) {
  std::mt19937 random(10);
  ContextCounts counts(1, kSymbols);
  for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
    for (std::size_t n = 0; n < 8u << symbol % 8; ++n) counts.add(0, symbol);
  }
  const ContextTables contexts(counts);
  const RansTables tables(contexts);
  Sequence sequence(contexts, 0, random);
  double bits = 0;
  for (std::size_t symbol = 0; symbol < kSymbols; ++symbol) {
    const std::uint16_t frequency = contexts.tables()[0][symbol];
    sequence.symbols.insert(sequence.symbols.end(), 16u * frequency, static_cast<std::uint8_t>(symbol));
    bits += 16.0 * frequency * std::log2(double{ContextTables::kScale} / frequency);
  }
  std::ranges::shuffle(sequence.symbols, random);
  sequence.tables.assign(sequence.symbols.size(), 0);
  const auto bytes = encoded<TypeParam::value>(tables, sequence, sequence.symbols.size());
  EXPECT_GT(8.0 * static_cast<double>(bytes.size()), 0.999 * bits);
  EXPECT_LT(8.0 * static_cast<double>(bytes.size()), 1.005 * bits + 32.0 * TypeParam::value);
}

TYPED_TEST(RansCoder, CarriesBytesAlong) {
  constexpr std::size_t kStates = TypeParam::value, kAlong = RansEncoder<kStates>::kAlong;
  std::mt19937 random(19);
  for (std::size_t count = 0; count < 90; ++count) {
    const ContextTables contexts(some_counts(random));
    const RansTables tables(contexts);
    const Sequence sequence(contexts, count, random);
    std::vector<std::byte> along(random() % (kAlong + 1));
    for (std::byte& byte : along) byte = static_cast<std::byte>(random());
    const auto bytes = encoded<kStates>(tables, sequence, 7, along);
    RansDecoder<kStates> decoder(tables, bytes);
    ASSERT_TRUE(takes(decoder, sequence, 7));
    std::array<std::byte, kAlong> found;
    ASSERT_TRUE(decoder.take_along(found));
    along.resize(kAlong);
    EXPECT_TRUE(std::ranges::equal(found, along));
    EXPECT_EQ(decoder.at_end(), std::ranges::count(along, std::byte{0}) == kAlong);
    // Bytes that are carried along make the code longer by at most two bytes for each state.
    EXPECT_LE(bytes.size(), encoded<kStates>(tables, sequence, 7).size() + 2 * kStates);
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      RansDecoder<kStates> cut(tables, std::span(bytes).first(length));
      EXPECT_FALSE(takes(cut, sequence, 7) && cut.take_along(found) && std::ranges::equal(found, along));
    }
  }
}

}  // namespace
}  // namespace adamas
