#pragma once

#include <cstdint>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// Counts of what was read of a store.
struct PageReads {
  std::uint64_t pages = 0;       ///< read for their own sake
  std::uint64_t predictors = 0;  ///< read only since others are predicted from them
  std::uint64_t bytes = 0;       ///< of both kinds of pages and of the directory
  std::uint64_t copies = 0;      ///< pages that were damaged, of which the second copy was whole
  std::uint64_t damaged = 0;     ///< pages that cannot be had

  PageReads& operator+=(const PageReads& other) {
    pages += other.pages;
    predictors += other.predictors;
    bytes += other.bytes;
    copies += other.copies;
    damaged += other.damaged;
    return *this;
  }
};

}  // namespace adamas
