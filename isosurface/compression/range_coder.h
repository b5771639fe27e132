#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "isosurface/compression/bit_stream.h"
#include "isosurface/compression/symbol_frequencies.h"

namespace adamas {

/// Frequencies of several groups of contexts as tables for range variants of asymmetric numeral systems
/// (rANS, Duda 2014). kStates sequences are coded in turn, so that a processor works at several symbols at
/// once.
///
/// A state x is below 2^28, and from kScale on except where nothing is left to read. A symbol of frequency f
/// that starts at b takes x to kScale floor(x / f) + b + x mod f, before which the lowest 16 bits go to the
/// stream if the result had more than 28.
class RangeTables {
 public:
  static constexpr int kStates = 4;
  static constexpr std::uint32_t kLeast = SymbolFrequencies::kScale;
  static constexpr int kWordBits = 16;
  using States = std::array<std::uint32_t, kStates>;

  explicit RangeTables(std::span<const SymbolFrequencies> groups);

  [[nodiscard]] bool has(std::size_t group, std::size_t symbol) const {
    return ranges_[group * kMaxSymbols + symbol].size > 0;
  }

  /// Puts a symbol on a state; a word that leaves it goes to the end of `words`.
  void push(std::uint32_t& x, std::size_t group, std::size_t symbol, std::vector<std::byte>& words) const {
    const Range range = ranges_[group * kMaxSymbols + symbol];
    ADAMAS_ASSERT(range.size > 0);
    if (x >= std::uint32_t{range.size} << kWordBits) {
      words.push_back(static_cast<std::byte>(x & 0xff));
      words.push_back(static_cast<std::byte>(x >> 8 & 0xff));
      x >>= kWordBits;
    }
    x = (x / range.size << SymbolFrequencies::kScaleBits) + range.start + x % range.size;
  }

  /// By group and the lowest bits of a state: from the lowest bit, 8 bits for the symbol, 12 for how far it
  /// is from the symbol's start and 12 for the symbol's frequency.
  [[nodiscard]] const std::uint32_t* entries() const { return entries_.data(); }

 private:
  static constexpr std::size_t kMaxSymbols = SymbolFrequencies::kMaxSymbols;
  struct Range {
    std::uint16_t start = 0, size = 0;
  };

  std::vector<Range> ranges_;  ///< by group and symbol
  std::vector<std::uint32_t> entries_;
};

/// Takes symbols from states and words again, the words from the last one to the first.
class RangeDecoder {
 public:
  /// How many bytes before `begin` must be readable: as many as kBlock symbols take.
  static constexpr std::size_t kSlack = 32;

  /// Words end at `end` and do not begin before `begin`.
  RangeDecoder(const RangeTables& tables, const RangeTables::States& states, const std::byte* begin,
               const std::byte* end)
      : entries_(tables.entries()), states_(states), begin_(begin), next_(end) {}

  /// One symbol per group. Returns false, and leaves anything in `symbols`, where the words are used up.
  [[nodiscard]] bool take(std::span<const std::uint8_t> groups, std::uint8_t* symbols);

  /// Whether what remains is how all sequences begin; and what is left of the words ends here.
  [[nodiscard]] bool at_start() const {
    for (const std::uint32_t x : states_) {
      if (x != RangeTables::kLeast) return false;
    }
    return next_ >= begin_;
  }
  [[nodiscard]] const std::byte* words() const { return next_; }

 private:
  static constexpr std::size_t kBlock = kSlack / 2;

  const std::uint32_t* entries_;
  RangeTables::States states_;
  const std::byte *begin_, *next_;
};

}  // namespace adamas
