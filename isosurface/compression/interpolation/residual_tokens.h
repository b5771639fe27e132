#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isosurface/compression/entropy/rans_coder.h"
#include "isosurface/volume/page.h"

namespace adamas::isosurface {

/// A residual modulo 2^bits as a token, for entropy coding, and its extra bits. The residual is folded first,
/// so that numbers of small magnitude are small: 0, -1, 1, -2, ... become 0, 1, 2, 3, ... A folded residual
/// below kDirect is its own token; greater ones have a token for each position of the leading 1 and the two
/// bits below it.
template <class Word>
struct ResidualToken {
  static constexpr int kBits = 8 * static_cast<int>(sizeof(Word));
  static constexpr int kDirect = 16;
  static constexpr int kTokens = kDirect + 4 * (kBits - 4);
  /// One more token, for single bytes: the sample is the volume's prevailing one. It has a bit that no other
  /// token has.
  static constexpr int kPrevailing = kTokens;
  static constexpr bool kHasPrevailing = kBits == 8 && std::has_single_bit(unsigned{kPrevailing});

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
  /// Returns the number of extra bits of a token: the lowest ones of the folded residual.
  static constexpr int extra_bits(int token) { return token < kDirect ? 0 : (token - kDirect) / 4 + 2; }
  static constexpr Word join(int token, Word extra) {
    if (token < kDirect) return static_cast<Word>(token);
    const int open = extra_bits(token);
    return static_cast<Word>(Word(4 + (token & 3)) << open | extra);
  }
};

/// Codes folded residuals as tokens, by a RansEncoder, and the plain extra bits of tokens.
template <class Word>
class ResidualWriter {
 public:
  static constexpr std::size_t kStates = 16;

  ResidualWriter(const RansTables& tables, std::size_t count) : encoder_(tables, count) {}

  /// Adds residuals, at most PageGrid::kPoints, that one call of ResidualReader::take will return, and the
  /// table of the token of each. `prevailing`, if not null: 1 where that token is coded, else 0.
  void put(std::span<const std::uint8_t> tables, const Word* folded,
           const std::uint8_t* prevailing = nullptr);
  void finish(std::vector<std::byte>& out, std::span<const std::byte> along) const {
    encoder_.finish(out, along);
  }

 private:
  RansEncoder<kStates> encoder_;
};

/// Takes folded residuals from the bytes of a ResidualWriter.
template <class Word>
class ResidualReader {
 public:
  ResidualReader(const RansTables& tables, std::span<const std::byte> bytes) : decoder_(tables, bytes) {}

  /// Takes one residual per table, at most PageGrid::kPoints of them. Returns false, with undefined `folded`,
  /// where the bytes are invalid.
  [[nodiscard]] bool take(std::span<const std::uint8_t> tables, Word* folded);
  /// Returns marks of the residuals that were taken last: 1 for those whose token is kPrevailing, which are
  /// 0, and 0 for others. Null where there is none.
  [[nodiscard]] const std::uint8_t* prevailing() const {
    return any_prevailing_ ? prevailing_.data() : nullptr;
  }
  /// Returns whether everything that was written has been taken, and some residual was not zero. Sets the
  /// bytes that were carried along.
  [[nodiscard]] bool at_end(BytesAlong& along) const { return any_ && decoder_.take_along(along); }

 private:
  using Token = ResidualToken<Word>;

  /// Adds the extra bits of so many tokens.
  void join(const std::uint8_t* tokens, std::size_t count, Word* folded);
  /// Replaces tokens kPrevailing by 0 and marks them.
  void extract_prevailing(Word* tokens, std::size_t count);
  template <bool Wide>
  void join_eight(const std::uint8_t* tokens, Word* folded);
  Word join_one(int token) {
    return Token::join(token, static_cast<Word>(decoder_.bits().take(Token::extra_bits(token))));
  }
  void join_open_wide(const std::uint8_t* tokens, Word* folded);

  RansDecoder<ResidualWriter<Word>::kStates> decoder_;
  bool any_ = false;  ///< whether a token was not that of zero
  /// The array has room for whole rows behind the last residual.
  std::array<std::uint8_t, Token::kHasPrevailing ? PageGrid::kPoints : 1> prevailing_;
  bool any_prevailing_ = false;
};

}  // namespace adamas::isosurface
