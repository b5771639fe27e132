#include "isosurface/compression/entropy/prefix_code.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>

#include "core/base/assert.h"
#include "core/base/error.h"

namespace adamas::isosurface {
namespace {

/// The coins of one denomination, sorted by weight: symbols, and pairs of coins of the next smaller
/// denomination.
struct Coins {
  std::vector<std::uint64_t> weights;
  std::vector<bool> is_symbol;
};

std::vector<std::size_t> used_symbols_by_count(std::span<const std::uint64_t> counts) {
  std::vector<std::size_t> symbols;
  for (std::size_t s = 0; s < counts.size(); ++s) {
    if (counts[s] > 0) symbols.push_back(s);
  }
  std::stable_sort(symbols.begin(), symbols.end(),
                   [counts](std::size_t a, std::size_t b) { return counts[a] < counts[b]; });
  return symbols;
}

/// Merges all symbols and the pairs of coins of the smaller denomination; at equal weight the symbol comes
/// first.
Coins merged_with_pairs(std::span<const std::uint64_t> symbol_weights, const Coins& smaller) {
  Coins coins;
  const std::size_t pairs = smaller.weights.size() / 2;
  const auto pair_weight = [&smaller](std::size_t n) {
    return smaller.weights[2 * n] + smaller.weights[2 * n + 1];
  };
  std::size_t symbol = 0, pair = 0;
  while (symbol < symbol_weights.size() || pair < pairs) {
    const bool take_symbol =
        pair == pairs || (symbol < symbol_weights.size() && symbol_weights[symbol] <= pair_weight(pair));
    coins.weights.push_back(take_symbol ? symbol_weights[symbol++] : pair_weight(pair++));
    coins.is_symbol.push_back(take_symbol);
  }
  return coins;
}

}  // namespace

std::vector<std::uint8_t> package_merge(std::span<const std::uint64_t> counts, int limit) {
  std::vector<std::uint8_t> lengths(counts.size(), 0);
  const std::vector<std::size_t> symbols = used_symbols_by_count(counts);
  ADAMAS_ASSERT(limit >= 1 && limit <= 32 && symbols.size() <= std::uint64_t{1} << limit);
  if (symbols.size() == 1) lengths[symbols[0]] = 1;
  if (symbols.size() < 2) return lengths;

  std::vector<std::uint64_t> weights;
  for (const std::size_t s : symbols) weights.push_back(counts[s]);
  // The loop goes from the smallest denomination, 2^-limit, to 1/2.
  std::vector<Coins> denominations;
  for (int n = 0; n < limit; ++n) {
    denominations.push_back(
        merged_with_pairs(weights, denominations.empty() ? Coins{} : denominations.back()));
  }
  // The lightest coins of 1/2 with a value of n - 1 make the code. Pairs are taken in order, and consist of
  // the first coins of the next smaller denomination; each time that a symbol is taken, its codeword grows by
  // one bit.
  std::size_t taken = 2 * (symbols.size() - 1);
  for (auto coins = denominations.rbegin(); coins != denominations.rend(); ++coins) {
    ADAMAS_ASSERT(taken <= coins->is_symbol.size());
    const auto begin = coins->is_symbol.begin();
    const auto taken_symbols =
        static_cast<std::size_t>(std::count(begin, begin + static_cast<std::ptrdiff_t>(taken), true));
    for (std::size_t n = 0; n < taken_symbols; ++n) ++lengths[symbols[n]];
    taken = 2 * (taken - taken_symbols);
  }
  return lengths;
}

namespace {

constexpr int kLengthBits = 4;

/// Reverses a codeword: its first bit is the highest of the number, and the lowest in a stream.
std::uint16_t reversed(std::uint32_t word, int length) {
  std::uint32_t result = 0;
  for (int b = 0; b < length; ++b) result |= (word >> b & 1u) << (length - 1 - b);
  return static_cast<std::uint16_t>(result);
}

void check_lengths(std::span<const std::uint8_t> lengths, std::string_view name) {
  constexpr std::uint32_t kWhole = 1u << CanonicalHuffman::kMaxLength;
  std::uint32_t sum = 0;
  std::size_t used = 0;
  for (const std::uint8_t length : lengths) {
    if (length > CanonicalHuffman::kMaxLength) {
      fail("{}: expected lengths up to {}, found {}", name, CanonicalHuffman::kMaxLength, length);
    }
    if (length == 0) continue;
    ++used;
    sum += kWhole >> length;
  }
  const bool alone = used == 1 && sum == kWhole / 2;
  if (used > 0 && !alone && sum != kWhole) {
    fail("{}: expected lengths with a Kraft sum of 1, found {}/{}", name, sum, kWhole);
  }
}

int number_bits(std::size_t symbols) { return static_cast<int>(std::bit_width(symbols)); }

}  // namespace

CanonicalHuffman::CanonicalHuffman(std::span<const std::uint8_t> lengths, std::string_view name) {
  ADAMAS_ASSERT(lengths.size() <= kMaxSymbols);
  check_lengths(lengths, name);
  int longest = 0;
  for (const std::uint8_t length : lengths) {
    words_.push_back({0, length});
    longest = std::max<int>(longest, length);
  }
  assign_words();
  fill_matches(longest);
}

void CanonicalHuffman::assign_words() {
  std::array<std::uint32_t, kMaxLength + 2> next{};
  for (const Word& word : words_) {
    if (word.length > 0) ++next[word.length + 1u];
  }
  // The first codeword of each length follows from the number of codewords of the length before.
  for (std::size_t length = 1; length < next.size(); ++length)
    next[length] = (next[length - 1] + next[length]) * 2;
  for (Word& word : words_) {
    if (word.length > 0) word.bits = reversed(next[word.length]++, word.length);
  }
}

void CanonicalHuffman::fill_matches(int longest) {
  matches_.resize(std::size_t{1} << longest);
  for (std::size_t symbol = 0; symbol < words_.size(); ++symbol) {
    const Word word = words_[symbol];
    if (word.length == 0) continue;
    const std::size_t step = std::size_t{1} << word.length;
    for (std::size_t window = word.bits; window < matches_.size(); window += step) {
      matches_[window] = {static_cast<std::uint8_t>(symbol), word.length};
    }
  }
}

void CanonicalHuffman::write(BitWriter& out) const {
  std::size_t count = words_.size();
  while (count > 0 && words_[count - 1].length == 0) --count;
  out.put(count, number_bits(words_.size()));
  for (std::size_t symbol = 0; symbol < count; ++symbol) out.put(words_[symbol].length, kLengthBits);
}

CanonicalHuffman CanonicalHuffman::read(BitReader& in, std::size_t symbols, std::string_view name) {
  ADAMAS_ASSERT(symbols <= kMaxSymbols);
  in.refill();
  const std::size_t count = in.take(number_bits(symbols));
  if (count > symbols) fail("{}: expected at most {} lengths, found {}", name, symbols, count);
  std::vector<std::uint8_t> lengths(symbols, 0);
  for (std::size_t symbol = 0; symbol < count; ++symbol) {
    in.refill();
    lengths[symbol] = static_cast<std::uint8_t>(in.take(kLengthBits));
  }
  if (in.overrun()) fail("{}: expected {} lengths, found the end of the data", name, count);
  // A code has one representation, so that equal codes are equal bytes.
  if (count > 0 && lengths[count - 1] == 0) fail("{}: expected a last length above 0, found 0", name);
  return CanonicalHuffman(lengths, name);
}

}  // namespace adamas::isosurface
