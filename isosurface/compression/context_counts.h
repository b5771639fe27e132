#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/assert.h"

namespace adamas {

/// How often each symbol comes in each context.
class ContextCounts {
 public:
  /// Contexts 0 to contexts - 1 and symbols 0 to symbols - 1.
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

  /// Of each symbol in the context.
  [[nodiscard]] std::span<const std::uint64_t> of(std::size_t context) const {
    return std::span(counts_).subspan(context * symbols_, symbols_);
  }

 private:
  std::size_t contexts_, symbols_;
  std::vector<std::uint64_t> counts_;
};

}  // namespace adamas
