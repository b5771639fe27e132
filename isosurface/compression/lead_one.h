#pragma once

#include <bit>
#include <cstdint>

#include "core/base/assert.h"

namespace adamas {

/// A residual, a number modulo 2^bits, as the position of the leading 1 of its magnitude and what that leaves
/// open. It counts as a number from -2^(bits-1) to 2^(bits-1) - 1. Its symbol is 0 for zero and else one more
/// than the exponent of the greatest power of 2 in its magnitude; the extra bits are the sign, lowest and 1
/// for negative, and the magnitude's bits below the leading 1. Only -2^(bits-1) has the symbol `bits`, so it
/// needs none.
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

  /// Bits of the residual beyond the modulus are ignored.
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

}  // namespace adamas
