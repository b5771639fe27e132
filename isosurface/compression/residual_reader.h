#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include "isosurface/compression/bit_stream.h"
#include "isosurface/compression/range_coder.h"
#include "isosurface/compression/residual_token.h"
#include "isosurface/volume/page_grid.h"

namespace adamas {

/// Takes folded residuals from a page's bytes: states, the plain bits of what tokens leave open, words (see
/// InterpolationCodec).
template <class Word>
class ResidualReader {
 public:
  /// Of how long a state is, which has so many bits below its leading 1, and kLeastBits more.
  static constexpr int kLengthBits = 4;
  static constexpr int kLeastBits = SymbolFrequencies::kScaleBits;
  /// A page that is longer is not one.
  static constexpr std::size_t kMostBytes = PageGrid::kPoints * sizeof(Word);

  ResidualReader(const RangeTables& tables, std::span<const std::byte> bytes);
  ResidualReader(const ResidualReader&) = delete;
  ResidualReader& operator=(const ResidualReader&) = delete;

  /// One residual per group; at most kPoints of them. Returns false, and leaves anything in `folded`, where
  /// the bytes are not what was written.
  [[nodiscard]] bool take(std::span<const std::uint8_t> groups, Word* folded);
  /// Whether all bytes were used, none of which could be others.
  [[nodiscard]] bool at_end() const;

 private:
  using Token = ResidualToken<Word>;
  using Symbols = std::span<const std::uint8_t>;

  [[nodiscard]] const std::byte* begin() const { return buffer_.data() + RangeDecoder::kSlack; }

  /// Where the next plain bit lies; the zeros after the page for those beyond it.
  [[nodiscard]] std::size_t next_byte() const { return taken_ / 8 < size_ ? taken_ / 8 : size_; }
  /// The plain bits from the next one on, 57 or more; zeros beyond the page.
  [[nodiscard]] std::uint64_t window() const {
    std::uint64_t bits = 0;
    std::memcpy(&bits, begin() + next_byte(), sizeof bits);
    return little_endian(bits) >> taken_ % 8;
  }
  std::uint64_t take(int bits) {
    const std::uint64_t found = window() & ((std::uint64_t{1} << bits) - 1);
    taken_ += static_cast<std::size_t>(bits);
    return found;
  }

  /// Adds what symbols leave open.
  bool join(Symbols groups, const std::uint8_t* symbols, Word* folded);
  template <bool Wide>
  bool join_eight(const std::uint8_t* groups, const std::uint8_t* symbols, Word* folded);
  bool join_one(std::size_t group, int symbol, Word& folded);
  /// Eight symbols that are tokens.
  void join_tokens(const std::uint8_t* symbols, Word* folded);
  void join_tokens_wide(const std::uint8_t* symbols, Word* folded);

  const RangeTables& tables_;
  std::size_t size_;
  std::size_t taken_ = 0;  ///< bits
  bool any_ = false;       ///< whether a residual was not zero
  std::array<std::byte, RangeDecoder::kSlack + kMostBytes + sizeof(std::uint64_t)> buffer_;
  std::optional<RangeDecoder> decoder_;
};

}  // namespace adamas
