#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "isosurface/compression/symbol_frequencies.h"

namespace adamas {

/// How often each symbol came in each context: one row of counts per context.
using ContextTallies = std::vector<std::vector<std::uint64_t>>;

/// Contexts that share frequencies: as many groups as pay for the bytes that theirs take.
class ContextGroups {
 public:
  /// Groups for sequences with these counts, of each symbol but the escape; a symbol that a group has no
  /// frequency for costs an escape and so many bits.
  ContextGroups(const ContextTallies& counts, int escape_bits);

  [[nodiscard]] std::size_t contexts() const { return groups_.size(); }
  /// The group of each context. They are numbered in the order in which they come first.
  [[nodiscard]] std::span<const std::uint8_t> groups() const { return groups_; }
  /// Of each group.
  [[nodiscard]] const std::vector<SymbolFrequencies>& frequencies() const { return frequencies_; }

  void write(BitWriter& out) const;
  /// What `write` has written for so many contexts and symbols, the escape included. Throws Error, which
  /// begins with `name`.
  [[nodiscard]] static ContextGroups read(BitReader& in, std::size_t contexts, std::size_t symbols,
                                          std::string_view name);

 private:
  ContextGroups() = default;

  std::vector<std::uint8_t> groups_;
  std::vector<SymbolFrequencies> frequencies_;
};

}  // namespace adamas
