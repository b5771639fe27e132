#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/bit_stream.h"
#include "isosurface/compression/context_counts.h"

namespace adamas {

/// An entropy code of symbols that come in contexts, with fixed frequencies for each: range asymmetric
/// numeral systems (Duda 2009), four states in turn. Contexts with like frequencies share a table. Each
/// symbol can be coded in each context: those without a frequency of their own are an escape, and come after
/// the row of symbols that each state has one of. May be used by several threads at once.
class ContextCoder {
 public:
  static constexpr std::size_t kMaxSymbols = 128, kMaxTables = 255;
  /// Tables that are made: so many stay in the caches.
  static constexpr std::size_t kMostClusters = 64;
  static constexpr int kScaleBits = 10;
  static constexpr std::uint32_t kScale = 1u << kScaleBits;
  static constexpr std::size_t kLanes = 4;
  static constexpr std::uint32_t kLeastState = 1u << 16;

  /// Of frequencies that code just so many symbols well.
  explicit ContextCoder(const ContextCounts& counts);

  [[nodiscard]] std::size_t contexts() const { return map_.size(); }
  [[nodiscard]] std::size_t symbols() const { return symbols_; }

  /// Writes what `read` makes the coder of again.
  void write(BitWriter& out) const;
  /// Throws Error, which begins with `name`, unless `write` of a coder could have given this.
  [[nodiscard]] static ContextCoder read(BitReader& in, std::size_t contexts, std::size_t symbols,
                                         std::string_view name);

  /// A slot's symbol (the lowest 8 bits, kEscape for the escape), its frequency (12 bits), and the slot's
  /// place among those of the symbol.
  using Entry = std::uint32_t;
  static constexpr std::uint32_t kEscape = 255;

  struct Range {
    std::uint16_t start = 0, frequency = 0;
  };
  [[nodiscard]] Range range(std::size_t context, std::size_t symbol) const {
    return ranges_[map_[context] * (symbols_ + 1) + symbol];
  }
  [[nodiscard]] Range escape(std::size_t context) const { return range(context, symbols_); }
  /// The tables as a decoder reads them, of contexts from some one on.
  struct View {
    const std::uint8_t* map;
    const Entry* all;
    [[nodiscard]] const Entry* entries(std::size_t context) const {
      return all + (std::size_t{map[context]} << kScaleBits);
    }
  };
  [[nodiscard]] View tables_view(std::size_t first) const { return {map_.data() + first, entries_.data()}; }

 private:
  /// A frequency for each symbol, then that of the escape; their sum is kScale.
  using Frequencies = std::vector<std::uint16_t>;

  ContextCoder(std::size_t symbols, std::vector<std::uint8_t> map, std::vector<Frequencies> tables);
  static Frequencies read_frequencies(BitReader& in, std::size_t symbols, std::string_view name);

  std::size_t symbols_;
  std::vector<std::uint8_t> map_;  ///< the context's table
  std::vector<Frequencies> tables_;
  std::vector<Range> ranges_;   ///< by table and symbol
  std::vector<Entry> entries_;  ///< by table and slot
};

/// Takes symbols down and codes them all at the end: the last one has to be coded first.
class ContextEncoder {
 public:
  explicit ContextEncoder(const ContextCoder& coder) : coder_(coder) {}

  /// What one call of ContextDecoder::decode will give. Contexts are added to `base`.
  void put(std::size_t base, std::span<const std::uint8_t> contexts, std::span<const std::uint8_t> symbols);
  /// Appends the bytes to `out`.
  void finish(std::vector<std::byte>& out) const;

 private:
  struct Item {
    std::uint16_t context;
    std::uint8_t symbol, lane;
  };

  const ContextCoder& coder_;
  std::vector<Item> items_;
};

/// Decodes what a ContextEncoder has coded. Reads nothing outside the span; whether the bytes were right is
/// seen at the end.
class ContextDecoder {
 public:
  ContextDecoder(const ContextCoder& coder, std::span<const std::byte> bytes);

  /// Fills `symbols`, one for each context, which is added to `base`.
  void decode(std::size_t base, std::span<const std::uint8_t> contexts, std::span<std::uint8_t> symbols);
  /// Whether the bytes end here, and no symbol was wrong.
  [[nodiscard]] bool finish() const;

 private:
  /// Puts in the place of a row's escapes what comes after the row: symbols without a frequency in their
  /// contexts.
  void decode_escaped(std::size_t base, std::span<const std::uint8_t> contexts, std::uint8_t* symbols);
  void renormalise(std::uint32_t& state);
  std::size_t decode_most(std::size_t base, std::span<const std::uint8_t> contexts,
                          std::span<std::uint8_t> symbols);

  const ContextCoder& coder_;
  const std::byte* next_;
  const std::byte* end_;
  std::array<std::uint32_t, ContextCoder::kLanes> states_{};
  bool good_ = true;
};

}  // namespace adamas
