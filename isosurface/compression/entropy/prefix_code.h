#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/entropy/bit_stream.h"

namespace adamas::isosurface {

/// Returns the lengths of the codewords of an optimal prefix code, that is, with the least sum of count times
/// length, whose codewords have at most `limit` bits (Larmore and Hirschberg 1990, the package-merge
/// algorithm). A symbol that does not occur gets length 0, and a single one gets length 1. At most 2^limit
/// symbols occur, 1 <= limit <= 32, and the counts add up to less than 2^58. Of two symbols that occur
/// equally often the later one never has the longer codeword, so the same counts give the same lengths.
[[nodiscard]] std::vector<std::uint8_t> package_merge(std::span<const std::uint64_t> counts, int limit);

/// A prefix code that is determined by its lengths (Schwartz and Kallick 1964): shorter words come before
/// longer ones, and words of one length are in the order of their symbols.
class CanonicalHuffman {
 public:
  static constexpr int kMaxLength = 12;
  static constexpr std::size_t kMaxSymbols = 256;

  /// A codeword as it is written to a stream, its first bit lowest; no bits for a symbol without a codeword.
  struct Word {
    std::uint16_t bits = 0;
    std::uint8_t length = 0;
  };
  /// The codeword at the beginning of a stream; its length is 0 where there is none.
  struct Match {
    std::uint8_t symbol = 0;
    std::uint8_t length = 0;
  };

  /// Makes a code from one length per symbol, 0 for symbols without a codeword. Throws Error, which begins
  /// with `name`, unless the codewords use up all streams exactly (Kraft's sum is 1); a code with no
  /// codeword, or a single one of length 1, is allowed too.
  explicit CanonicalHuffman(std::span<const std::uint8_t> lengths, std::string_view name = "prefix code");

  [[nodiscard]] std::span<const Word> words() const { return words_; }
  /// Finds the codeword at the beginning of the lowest kMaxLength bits of a window.
  [[nodiscard]] Match match(std::uint64_t window) const { return matches_[window & (matches_.size() - 1)]; }

  /// Writes the number of lengths, up to that of the last symbol with a codeword, and 4 bits for each.
  void write(BitWriter& out) const;
  /// Reads a code of `symbols` symbols that `write` has written. Throws Error, which begins with `name`.
  [[nodiscard]] static CanonicalHuffman read(BitReader& in, std::size_t symbols, std::string_view name);

 private:
  void assign_words();
  void fill_matches(int longest);

  std::vector<Word> words_;
  std::vector<Match> matches_;
};

}  // namespace adamas::isosurface
