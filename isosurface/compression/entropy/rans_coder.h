#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "isosurface/compression/entropy/bit_stream.h"
#include "isosurface/compression/entropy/context_tables.h"

namespace adamas::isosurface {

/// ContextTables prepared for coding by range variants of asymmetric numeral systems, rANS (J. Duda,
/// "Asymmetric numeral systems: entropy coding combining speed of Huffman coding with compression rate of
/// arithmetic coding", arXiv:1311.2540). Several threads may use them at once.
///
/// A state x is from kLeast on and below 2^16 kLeast. A symbol of frequency f, before which come frequencies
/// with the sum b, takes x to kScale floor(x / f) + b + x mod f. If that would be too great the lowest 16
/// bits of x go to the words first.
class RansTables {
 public:
  static constexpr std::uint32_t kLeast = ContextTables::kScale;
  static constexpr int kWordBits = 16;
  /// The escape's number in a decoder's entry; no symbol has the highest bit.
  static constexpr std::uint8_t kEscape = 255;

  explicit RansTables(const ContextTables& tables);

  [[nodiscard]] std::size_t symbols() const { return symbols_; }
  /// Returns the number of bits of an escaped symbol's number.
  [[nodiscard]] int escaped_bits() const { return static_cast<int>(std::bit_width(symbols_ - 1)); }
  /// The slots of a symbol, or of the escape after all symbols, among the kScale slots of its table.
  struct Slots {
    std::uint16_t start = 0, size = 0;
    /// 2^kReciprocalBits / size, rounded up: near enough for exact quotients of states.
    std::uint64_t reciprocal = 0;
  };
  static constexpr int kReciprocalBits = 2 * ContextTables::kScaleBits + kWordBits;
  /// Returns the slots of all symbols and escapes of all tables, indexed by `place`.
  [[nodiscard]] const Slots* slots() const { return slots_.data(); }
  [[nodiscard]] std::size_t place(std::size_t table, std::size_t symbol) const {
    return table * (symbols_ + 1) + symbol;
  }
  /// Returns whether the table codes the symbol without the escape.
  [[nodiscard]] bool has(std::size_t table, std::size_t symbol) const {
    return slots_[place(table, symbol)].size > 0;
  }

  /// Returns the decoder's entries, indexed by table and the lowest kScaleBits of a state. An entry has the
  /// symbol in the lowest 8 bits, then in 12 bits each the distance of the slot from the symbol's first one,
  /// and the symbol's frequency.
  [[nodiscard]] const std::uint32_t* entries() const { return entries_.data(); }

 private:
  std::size_t symbols_;
  std::vector<Slots> slots_;  ///< by table and symbol
  std::vector<std::uint32_t> entries_;
};

/// Collects symbols and plain bits and codes them all at the end, since the last symbol has to be coded
/// first.
///
/// kStates states take symbols in turn, so that a processor works at several symbols at once. They begin at
/// kLeast, or at values below 2 kLeast, whose lowest bits are bytes that are carried along. The bytes are:
/// each state, as 4 bits with the position of its leading 1 above that of kLeast and the bits below this 1;
/// the plain bits; zeros up to a whole byte; the words of 16 bits, low byte first, in the reverse of the
/// order in which a decoder needs them.
template <std::size_t kStates>
class RansEncoder {
 public:
  /// Makes an empty encoder. `expected` is the approximate number of symbols.
  RansEncoder(const RansTables& tables, std::size_t expected);

  /// Adds symbols that one call of RansDecoder::take will return, and the table of each. The numbers of
  /// symbols that their tables do not code become plain bits.
  void put(std::span<const std::uint8_t> tables, std::span<const std::uint8_t> symbols);
  /// Adds plain bits, fewer than 64.
  void put_bits(std::uint64_t bits, int count) { bits_.push_back({bits, count}); }
  /// Appends the bytes to `out`. `along`: at most kAlong bytes, which RansDecoder::take_along returns.
  void finish(std::vector<std::byte>& out, std::span<const std::byte> along = {}) const;
  static constexpr std::size_t kAlong = kStates * ContextTables::kScaleBits / 8;

 private:
  struct Bits {
    std::uint64_t bits;
    int count;
  };

  const RansTables& tables_;
  std::vector<std::uint16_t> places_;  ///< the slots of the symbols
  std::vector<Bits> bits_;
};

/// Decodes the bytes of a RansEncoder with as many states. It reads nothing outside of the bytes, even if
/// they are invalid.
template <std::size_t kStates>
class RansDecoder {
 public:
  RansDecoder(const RansTables& tables, std::span<const std::byte> bytes);

  /// Takes one symbol from each of these tables. Returns false, with undefined `symbols`, where the bytes are
  /// invalid.
  [[nodiscard]] bool take(std::span<const std::uint8_t> tables, std::uint8_t* symbols);
  /// Returns the plain bits from the next one on.
  [[nodiscard]] BitCursor& bits() { return bits_; }
  /// Returns whether everything that was coded has been taken, and nothing was carried along.
  [[nodiscard]] bool at_end() const;
  /// Returns the bytes that were carried along, with zeros behind them. Returns false where not all symbols
  /// and bits have been taken.
  [[nodiscard]] bool take_along(std::span<std::byte, RansEncoder<kStates>::kAlong> along) const;

 private:
  /// The number of bytes before the words that must be readable: as many as a symbol of each state takes.
  static constexpr std::size_t kSlack = 2 * kStates;

  bool take_escaped(std::span<const std::uint8_t> tables, std::uint8_t* symbols);

  const RansTables& tables_;
  std::unique_ptr<std::byte[]> memory_;  ///< the bytes between zeros
  const std::byte *begin_, *next_;       ///< the beginning of the bytes, and the end of the next word
  BitCursor bits_;
  std::array<std::uint32_t, kStates> states_;
};

}  // namespace adamas::isosurface
