#pragma once

#include "core/base/simd.h"

namespace adamas::test {

/// While an object lives, vectors have 16 bytes, as on a processor that has no wider ones.
struct ShortVectors {
  ShortVectors() { only_short_vectors = true; }
  ~ShortVectors() { only_short_vectors = false; }
  ShortVectors(const ShortVectors&) = delete;
  ShortVectors& operator=(const ShortVectors&) = delete;
};

}  // namespace adamas::test
