#pragma once

#include <cstddef>
#include <cstring>

namespace adamas {

/// As many numbers as the narrowest vector registers hold, computed with at a time. Operators are those of
/// the compilers' vector extension, which g++ and clang share; as the parameter of a template such a type
/// would lose its length, so it is a member of one.
template <class Real>
struct LanesOf {
  static constexpr std::size_t kCount = 16 / sizeof(Real);
  using Lanes __attribute__((vector_size(16))) = Real;

  static Lanes load(const Real* from) {
    Lanes lanes;
    std::memcpy(&lanes, from, sizeof lanes);
    return lanes;
  }
  static void store(Real* to, Lanes lanes) { std::memcpy(to, &lanes, sizeof lanes); }
  /// a where b is NaN.
  static Lanes greater(Lanes a, Lanes b) { return b > a ? b : a; }
};

}  // namespace adamas
