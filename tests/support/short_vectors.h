#pragma once

#include "core/base/simd.h"

namespace adamas::test {

/// Vectors of 16 bytes for a while, as on a processor that has no wider ones.
struct ShortVectors {
  ShortVectors() { only_short_vectors = true; }
  ~ShortVectors() { only_short_vectors = false; }
  ShortVectors(const ShortVectors&) = delete;
  ShortVectors& operator=(const ShortVectors&) = delete;
};

}  // namespace adamas::test
