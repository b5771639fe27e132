#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/assert.h"
#include "isosurface/compression/entropy/prefix_code.h"

namespace adamas::isosurface {

/// A residual, a number modulo 2^bits, as the position of the leading 1 of its magnitude and extra bits. It
/// counts as a number from -2^(bits-1) to 2^(bits-1) - 1. Its symbol is 0 for zero and else one more than the
/// exponent of the greatest power of 2 in its magnitude; the extra bits are the sign, lowest and 1 for
/// negative, and the magnitude's bits below the leading 1. Only -2^(bits-1) has the symbol `bits`, so it
/// needs no extra bits.
class LeadOne {
 public:
  static constexpr int kMaxBits = 32;

  constexpr explicit LeadOne(int bits) : bits_(bits) { ADAMAS_ASSERT(bits == 8 || bits == 16 || bits == 32); }

  struct Parts {
    int symbol;
    std::uint32_t extra;
  };

  [[nodiscard]] constexpr int bits() const { return bits_; }
  [[nodiscard]] constexpr int symbols() const { return bits_ + 1; }
  [[nodiscard]] constexpr std::uint32_t mask() const { return ~std::uint32_t{0} >> (kMaxBits - bits_); }
  [[nodiscard]] constexpr int extra_bits(int symbol) const { return symbol == bits_ ? 0 : symbol; }

  /// Splits a residual. Its bits beyond the modulus are ignored.
  [[nodiscard]] constexpr Parts split(std::uint32_t residual) const {
    const std::uint32_t negative = residual >> (bits_ - 1) & 1;
    const std::uint32_t magnitude = (negative != 0 ? 0 - residual : residual) & mask();
    const int symbol = std::bit_width(magnitude);
    if (symbol == 0 || symbol == bits_) return {symbol, 0};
    return {symbol, (magnitude ^ 1u << (symbol - 1)) << 1 | negative};
  }

  [[nodiscard]] constexpr std::uint32_t join(Parts parts) const {
    const auto lead = static_cast<std::uint32_t>(std::uint64_t{1} << parts.symbol >> 1);
    const std::uint32_t magnitude = lead | parts.extra >> 1;
    return ((parts.extra & 1) != 0 ? 0 - magnitude : magnitude) & mask();
  }

 private:
  int bits_;
};

/// Counts how often each symbol follows each other one, over the pages of one component of a volume.
class ResidualStatistics {
 public:
  /// Makes counts of 0 for residuals modulo 2^bits; bits is 8, 16 or 32.
  explicit ResidualStatistics(int bits)
      : lead_one_(bits), counts_(static_cast<std::size_t>(lead_one_.symbols() * lead_one_.symbols()), 0) {}

  [[nodiscard]] int bits() const { return lead_one_.bits(); }

  /// Counts a page, before which the symbol is 0.
  void add(std::span<const std::uint32_t> residuals) {
    int previous = 0;
    for (const std::uint32_t residual : residuals) {
      const int symbol = lead_one_.split(residual).symbol;
      ++counts_[static_cast<std::size_t>(previous * lead_one_.symbols() + symbol)];
      previous = symbol;
    }
  }

  /// Adds the counts of other pages, of residuals with as many bits.
  void merge(const ResidualStatistics& other) {
    ADAMAS_ASSERT(bits() == other.bits());
    for (std::size_t n = 0; n < counts_.size(); ++n) counts_[n] += other.counts_[n];
  }

  /// Returns the count of each symbol after `previous`.
  [[nodiscard]] std::span<const std::uint64_t> counts(int previous) const {
    const auto symbols = static_cast<std::size_t>(lead_one_.symbols());
    return std::span(counts_).subspan(static_cast<std::size_t>(previous) * symbols, symbols);
  }

 private:
  LeadOne lead_one_;
  std::vector<std::uint64_t> counts_;
};

/// The entropy code of a page of residuals of one component (the dissertation (D), chapter 4): the position
/// of a residual's leading 1 by a canonical Huffman code, which depends on the position before (0 at the
/// start of a page), then its sign and the bits below. Codewords have at most 12 bits. Several threads may
/// use a code at once.
class ResidualCode {
 public:
  /// Makes the best code for pages with these statistics. It codes only symbols that these count.
  explicit ResidualCode(const ResidualStatistics& statistics);

  /// Returns at most kMaxTableBytes bytes from which `parse` makes the code again; the same for equal codes.
  [[nodiscard]] std::vector<std::byte> serialise() const;
  static constexpr std::size_t kMaxTableBytes = 570;
  /// Makes a code from these bytes. Throws Error, which begins with `name`, unless `serialise` of a code with
  /// so many bits could have given just these bytes; bits is 8, 16 or 32.
  [[nodiscard]] static ResidualCode parse(std::span<const std::byte> tables, int bits, std::string_view name);

  [[nodiscard]] int bits() const { return lead_one_.bits(); }

  /// Returns whether the code has codewords for all of these.
  [[nodiscard]] bool codes(std::span<const std::uint32_t> residuals) const;

  /// Appends the page to `out`, in whole bytes. Bits of a residual beyond the modulus are ignored. Throws
  /// Error at a residual without a codeword; `out` is invalid then.
  void encode(std::span<const std::uint32_t> residuals, std::vector<std::byte>& out) const;

  /// Fills `residuals`, with numbers below 2^bits, from a page of so many. Returns false, with undefined
  /// `residuals`, unless `encode` of some residuals gives just these bytes. Then the caller throws the Error,
  /// since it knows the file and the page.
  [[nodiscard]] bool decode(std::span<const std::byte> page, std::span<std::uint32_t> residuals) const;

 private:
  /// One or two residuals at the beginning of a window of the stream, packed in a word.
  using Entry = std::uint32_t;

  ResidualCode(LeadOne lead_one, std::vector<CanonicalHuffman> codes);
  [[nodiscard]] Entry entry_of(int previous, std::uint32_t window) const;
  /// These functions return false where the stream has bits that are no codeword; the caller checks where it
  /// ends.
  bool decode_most(BitReader& reader, int& previous, std::span<std::uint32_t>& residuals) const;
  bool decode_one(BitReader& in, int& previous, std::uint32_t& residual) const;

  LeadOne lead_one_;
  std::vector<CanonicalHuffman> codes_;  ///< indexed by the previous symbol
  std::vector<Entry> entries_;           ///< indexed by the previous symbol and the window
};

}  // namespace adamas::isosurface
