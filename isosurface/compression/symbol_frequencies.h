#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/bit_stream.h"

namespace adamas {

/// How often each symbol comes in kScale symbols, as an entropy coder is told. The last symbol, an escape for
/// those that have no frequency, always has one.
class SymbolFrequencies {
 public:
  static constexpr int kScaleBits = 10;
  static constexpr std::uint32_t kScale = 1u << kScaleBits;
  static constexpr std::size_t kMaxSymbols = 256;

  /// Nearly the best for a sequence with these counts, one for each symbol but the escape.
  explicit SymbolFrequencies(std::span<const std::uint64_t> counts);

  /// One per symbol, the escape's last; their sum is kScale, and none is all of it.
  [[nodiscard]] std::span<const std::uint16_t> values() const { return values_; }

  /// Bits that `write` writes.
  [[nodiscard]] double written_bits() const;
  /// Bits of a sequence with these counts, where an escape costs `escape_bits` more.
  [[nodiscard]] double coded_bits(std::span<const std::uint64_t> counts, int escape_bits) const;

  void write(BitWriter& out) const;
  /// What `write` has written for so many symbols, the escape included. Throws Error, which begins with
  /// `name`.
  [[nodiscard]] static SymbolFrequencies read(BitReader& in, std::size_t symbols, std::string_view name);

 private:
  SymbolFrequencies() = default;
  /// Makes the sum kScale, where the least is lost.
  void balance(std::span<const std::uint64_t> counts);

  std::vector<std::uint16_t> values_;
};

}  // namespace adamas
