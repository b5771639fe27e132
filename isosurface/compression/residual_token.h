#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace adamas {

/// A residual modulo 2^bits as a token, for entropy coding, and what that leaves open. The residual is folded
/// first, so that numbers of small magnitude are small: 0, -1, 1, -2, ... become 0, 1, 2, 3, ... A folded one
/// below kDirect is its own token; others have one for each leading 1 and two bits below it.
template <class Word>
struct ResidualToken {
  static constexpr int kBits = 8 * static_cast<int>(sizeof(Word));
  static constexpr int kDirect = 16;
  static constexpr int kTokens = kDirect + 4 * (kBits - 4);
  /// The symbol that says that a token follows in kTokenBits plain bits.
  static constexpr int kEscape = kTokens;
  static constexpr int kTokenBits = std::bit_width(static_cast<unsigned>(kTokens - 1));

  static constexpr Word fold(Word residual) {
    const auto sign = static_cast<Word>(0 - (residual >> (kBits - 1)));
    return static_cast<Word>(static_cast<Word>(residual << 1) ^ sign);
  }
  static constexpr Word unfold(Word folded) {
    return static_cast<Word>((folded >> 1) ^ static_cast<Word>(0 - (folded & 1)));
  }

  static constexpr int token(Word folded) {
    if (folded < kDirect) return static_cast<int>(folded);
    const int exponent = std::bit_width(folded) - 1;
    return kDirect + 4 * (exponent - 4) + static_cast<int>(folded >> (exponent - 2) & 3);
  }
  /// Number of bits that a token leaves open: the lowest ones of what is folded.
  static constexpr int extra_bits(int token) { return token < kDirect ? 0 : (token - kDirect) / 4 + 2; }
  static constexpr Word join(int token, Word extra) {
    if (token < kDirect) return static_cast<Word>(token);
    const int open = extra_bits(token);
    return static_cast<Word>(Word(4 + (token & 3)) << open | extra);
  }
};

}  // namespace adamas
