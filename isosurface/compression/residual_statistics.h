#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "isosurface/compression/lead_one.h"

namespace adamas {

/// How often each symbol follows each, over the pages of one component of a volume.
class ResidualStatistics {
 public:
  /// Of residuals modulo 2^bits; bits is 8, 16 or 32.
  explicit ResidualStatistics(int bits)
      : lead_one_(bits), counts_(static_cast<std::size_t>(lead_one_.symbols() * lead_one_.symbols()), 0) {}

  [[nodiscard]] int bits() const { return lead_one_.bits(); }

  /// Counts a page, before which the symbol is 0.
  void add(std::span<const std::uint32_t> residuals) {
    int previous = 0;
    for (const std::uint32_t residual : residuals) {
      const int symbol = lead_one_.split(residual).symbol;
      ++counts_[static_cast<std::size_t>(previous * lead_one_.symbols() + symbol)];
      previous = symbol;
    }
  }

  /// Adds the counts of other pages, of residuals with as many bits.
  void merge(const ResidualStatistics& other) {
    ADAMAS_ASSERT(bits() == other.bits());
    for (std::size_t n = 0; n < counts_.size(); ++n) counts_[n] += other.counts_[n];
  }

  /// Of each symbol after `previous`.
  [[nodiscard]] std::span<const std::uint64_t> counts(int previous) const {
    const auto symbols = static_cast<std::size_t>(lead_one_.symbols());
    return std::span(counts_).subspan(static_cast<std::size_t>(previous) * symbols, symbols);
  }

 private:
  LeadOne lead_one_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace adamas
