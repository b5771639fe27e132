#pragma once

#include <bit>
#include <cstdint>

namespace adamas {

/// Where a range begins, as seen from the word `predicted` and the bound at or before it: a symbol, and bits
/// that it leaves open.
template <class Word>
struct RangeToken {
  static constexpr int kBits = 8 * sizeof(Word);
  static constexpr std::uint8_t kPredicted = 0;  ///< just there
  static constexpr std::uint8_t kBound = 1;      ///< at the bound, which is another word
  static constexpr std::uint8_t kFirst = 2;      ///< the distance is 1
  /// Shorter distances have a symbol each, others one for each leading 1 and the bit below it.
  static constexpr int kDirectBits = 5;
  static constexpr std::uint8_t kFirstOpen =
      kFirst + (1 << kDirectBits) - 1;  ///< from this one on bits follow
  static constexpr std::uint8_t kBehind =
      static_cast<std::uint8_t>(kFirstOpen + 2 * (kBits - kDirectBits));  ///< all bits follow
  static constexpr std::size_t kSymbols = kBehind + 1;

  std::uint8_t symbol = 0;
  std::uint32_t extra = 0;

  static constexpr RangeToken of(Word value, Word predicted, Word bound) {
    if (value == predicted) return {kPredicted, 0};
    if (value == bound) return {kBound, 0};
    if (value > predicted) return {kBehind, value};
    const auto distance = static_cast<std::uint32_t>(predicted - value);
    if (distance < 1u << kDirectBits) return {static_cast<std::uint8_t>(kFirst + distance - 1), 0};
    const auto bits = static_cast<int>(std::bit_width(distance));
    const std::uint32_t half = distance >> (bits - 2) & 1;
    return {static_cast<std::uint8_t>(kFirstOpen + 2 * (bits - kDirectBits - 1) + static_cast<int>(half)),
            distance & ((1u << (bits - 2)) - 1)};
  }

  /// Of a symbol from kFirst on.
  static constexpr int extra_bits(std::uint8_t symbol) {
    if (symbol == kBehind) return kBits;
    return symbol < kFirstOpen ? 0 : (symbol - kFirstOpen) / 2 + kDirectBits - 1;
  }

  /// The least distance of a symbol from kFirstOpen to before kBehind; its lowest bits are the extra ones.
  static constexpr std::uint32_t lead(std::uint8_t symbol) {
    const int number = symbol - kFirstOpen;
    return (2u | static_cast<std::uint32_t>(number & 1)) << (number / 2 + kDirectBits - 1);
  }

  /// The word from a symbol from kFirst on. Another token may stand for it too, or none if the symbol is not
  /// one that `of` gives.
  [[nodiscard]] constexpr Word value(Word predicted) const {
    if (symbol == kBehind) return static_cast<Word>(extra);
    if (symbol < kFirstOpen) return static_cast<Word>(predicted - (symbol - kFirst) - 1);
    return static_cast<Word>(predicted - (lead(symbol) | extra));
  }
};

}  // namespace adamas
