#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/canonical_huffman.h"
#include "isosurface/compression/lead_one.h"
#include "isosurface/compression/residual_statistics.h"

namespace adamas {

/// The entropy code of a page of residuals of one component (D 4): the position of a residual's leading 1
/// by a canonical Huffman code, which the position before chooses (0 at the start of a page), then its sign
/// and the bits below. Codewords have at most 12 bits. A code may be used by several threads at once.
class ResidualCode {
 public:
  /// The best code for pages with these statistics. It codes what they count, and nothing else.
  explicit ResidualCode(const ResidualStatistics& statistics);

  /// No more than kMaxTableBytes bytes from which `parse` makes the code again; the same for equal codes.
  [[nodiscard]] std::vector<std::byte> serialise() const;
  static constexpr std::size_t kMaxTableBytes = 570;
  /// Throws Error, which begins with `name`, unless `serialise` of a code with so many bits could have given
  /// just these bytes; bits is 8, 16 or 32.
  [[nodiscard]] static ResidualCode parse(std::span<const std::byte> tables, int bits, std::string_view name);

  [[nodiscard]] int bits() const { return lead_one_.bits(); }

  /// Whether the code has words for all of these.
  [[nodiscard]] bool codes(std::span<const std::uint32_t> residuals) const;

  /// Appends the page to `out`, in whole bytes. Bits of a residual beyond the modulus are ignored. Throws
  /// Error at a residual that the code has no word for; `out` is not to be used then.
  void encode(std::span<const std::uint32_t> residuals, std::vector<std::byte>& out) const;

  /// Fills `residuals`, with numbers below 2^bits, from a page of so many. Returns false, and leaves anything
  /// in `residuals`, unless `encode` of some residuals gives just these bytes: who calls knows the file and
  /// the page that are to be named.
  [[nodiscard]] bool decode(std::span<const std::byte> page, std::span<std::uint32_t> residuals) const;

 private:
  /// One or two residuals that a window of the stream begins with, packed in a word.
  using Entry = std::uint32_t;

  ResidualCode(LeadOne lead_one, std::vector<CanonicalHuffman> codes);
  [[nodiscard]] Entry entry_of(int previous, std::uint32_t window) const;
  /// Both return false where the stream has bits that are no codeword; the end is for who calls to see.
  bool decode_most(BitReader& reader, int& previous, std::span<std::uint32_t>& residuals) const;
  bool decode_one(BitReader& in, int& previous, std::uint32_t& residual) const;

  LeadOne lead_one_;
  std::vector<CanonicalHuffman> codes_;  ///< by the previous symbol
  std::vector<Entry> entries_;           ///< by the previous symbol and the window
};

}  // namespace adamas
