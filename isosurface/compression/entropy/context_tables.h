#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/assert.h"
#include "isosurface/compression/entropy/bit_stream.h"

namespace adamas::isosurface {

/// Counts the symbols in each context, for the tables of an entropy coder.
class ContextCounts {
 public:
  /// Makes counts of 0. Contexts are 0 to contexts - 1 and symbols are 0 to symbols - 1.
  ContextCounts(std::size_t contexts, std::size_t symbols)
      : contexts_(contexts), symbols_(symbols), counts_(contexts * symbols, 0) {}

  [[nodiscard]] std::size_t contexts() const { return contexts_; }
  [[nodiscard]] std::size_t symbols() const { return symbols_; }

  void add(std::size_t context, std::size_t symbol) {
    ADAMAS_ASSERT(context < contexts_ && symbol < symbols_);
    ++counts_[context * symbols_ + symbol];
  }

  /// Adds other counts, of as many contexts and symbols.
  void merge(const ContextCounts& other) {
    ADAMAS_ASSERT(contexts_ == other.contexts_ && symbols_ == other.symbols_);
    for (std::size_t n = 0; n < counts_.size(); ++n) counts_[n] += other.counts_[n];
  }

  [[nodiscard]] std::span<const std::uint64_t> counts(std::size_t context) const {
    return std::span(counts_).subspan(context * symbols_, symbols_);
  }

 private:
  std::size_t contexts_, symbols_;
  std::vector<std::uint64_t> counts_;
};

/// The frequency tables of an entropy coder of symbols in contexts. Contexts with similar counts share a
/// table, where a table of their own would cost more bits than it saves.
class ContextTables {
 public:
  /// The frequencies of a table sum to kScale.
  static constexpr int kScaleBits = 10;
  static constexpr std::uint32_t kScale = 1u << kScaleBits;
  static constexpr std::size_t kMaxSymbols = 128;
  /// The greatest number of tables; so many fit in the second-level cache of a processor.
  static constexpr std::size_t kMaxTables = 64;
  /// The frequencies of all symbols, 0 for a symbol that the table does not code; then that of the escape,
  /// which announces such a symbol and is never 0.
  using Frequencies = std::vector<std::uint16_t>;

  /// Makes tables that nearly minimise the bits of sequences with these counts, the tables' own bits
  /// included. A context that never occurs shares the table of the context before it.
  explicit ContextTables(const ContextCounts& counts);

  [[nodiscard]] std::size_t contexts() const { return table_of_context_.size(); }
  /// Returns the number of symbols without the escape.
  [[nodiscard]] std::size_t symbols() const { return symbols_; }
  /// Returns the table of each context. Tables are numbered in the order in which contexts first use them.
  [[nodiscard]] std::span<const std::uint8_t> tables_of_contexts() const { return table_of_context_; }
  [[nodiscard]] const std::vector<Frequencies>& tables() const { return tables_; }

  void write(BitWriter& out) const;
  /// Reads tables of so many contexts and symbols that `write` has written. Throws Error, which begins with
  /// `name`, where the bits are not a result of `write`.
  [[nodiscard]] static ContextTables read(BitReader& in, std::size_t contexts, std::size_t symbols,
                                          std::string_view name);

 private:
  explicit ContextTables(std::size_t symbols) : symbols_(symbols) {}

  std::size_t symbols_;
  std::vector<std::uint8_t> table_of_context_;
  std::vector<Frequencies> tables_;
};

}  // namespace adamas::isosurface
