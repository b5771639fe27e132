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
/// A state x is from kScale on and below 2^16 kScale. A symbol of frequency f that starts at b takes x to
/// kScale floor(x / f) + b + x mod f, before which the lowest 16 bits go to the stream if the result were too
/// great.
class RangeTables {
 public:
  static constexpr int kStates = 16;
  static constexpr std::uint32_t kLeast = SymbolFrequencies::kScale;
  static constexpr int kWordBits = 16;
  using States = std::array<std::uint32_t, kStates>;

  explicit RangeTables(std::span<const SymbolFrequencies> groups);

  [[nodiscard]] bool has(std::size_t group, std::size_t symbol) const {
    return ranges_[group * kMaxSymbols + symbol].size > 0;
  }

  /// Codes one symbol per group, of which the first will be the first that a RangeDecoder takes; a symbol
  /// that `has` denies has none. Words go to `words`, which has room for as many as there are symbols.
  /// Returns the end of those in use.
  std::uint16_t* encode(std::span<const std::uint8_t> groups, const std::uint8_t* symbols, States& states,
                        std::uint16_t* words) const;

  /// By group and the lowest bits of a state: from the lowest bit, 8 bits for the symbol, 12 for how far it
  /// is from the symbol's start and 12 for the symbol's frequency.
  [[nodiscard]] const std::uint32_t* entries() const { return entries_.data(); }

 private:
  static constexpr std::size_t kMaxSymbols = SymbolFrequencies::kMaxSymbols;
  struct Range {
    std::uint16_t start = 0, size = 0;
    /// 2^kReciprocalBits / size, rounded up: so near that quotients of states are right.
    std::uint64_t reciprocal = 0;
  };
  static constexpr int kReciprocalBits =
      SymbolFrequencies::kScaleBits + kWordBits + SymbolFrequencies::kScaleBits;

  std::vector<Range> ranges_;  ///< by group and symbol
  std::vector<std::uint32_t> entries_;
};

/// Takes symbols from states and words again, the words from the last one to the first.
class RangeDecoder {
 public:
  /// How many bytes before `begin` must be readable: as many as a symbol of each state takes.
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
  const std::uint32_t* entries_;
  RangeTables::States states_;
  const std::byte *begin_, *next_;
};

}  // namespace adamas
