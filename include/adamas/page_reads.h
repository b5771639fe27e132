#pragma once

#include <cstdint>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// Counts of pages and bytes that were read of a store.
struct PageReads {
  std::uint64_t pages = 0;       ///< pages that were read for their own sake
  std::uint64_t predictors = 0;  ///< pages that were read only since others are predicted from them
  std::uint64_t bytes = 0;       ///< bytes of both kinds of pages and of the directory
  std::uint64_t copies = 0;      ///< pages that were damaged, of which the second copy was whole
  std::uint64_t damaged = 0;     ///< pages that cannot be read

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
