#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/base/simd.h"

namespace adamas::isosurface {

/// Returns the codes on the ErrorScale of an LOD, given the squared ratios of the errors to the scale's
/// greatest error. Codes are rounded up, even if rounding has reduced `squared` by up to 2^-20. The code is 0
/// only for 0.
template <std::size_t Bytes>
[[gnu::always_inline]] inline typename Simd<std::int32_t, Bytes>::Numbers error_codes(
    typename Simd<float, Bytes>::Numbers squared) {
  using Lanes = Simd<std::int32_t, Bytes>;
  using Codes = typename Lanes::Numbers;
  // Codes are quarters of octaves of the error, so halves of octaves of its square.
  constexpr std::int32_t kRootOfTwo = 0x3504f3;  // its mantissa, rounded down
  constexpr std::int32_t kMantissa = 0x7fffff, kGreatest = 63;
  const auto raised = (squared > 1 ? decltype(squared){} + 1 : squared) * (1 + 0x1p-20f);
  Codes bits;
  std::memcpy(&bits, &raised, sizeof bits);
  // A comparison that is true gives -1.
  const Codes code = 64 + 2 * ((bits >> 23) - 127) - ((bits & kMantissa) > kRootOfTwo);
  return Lanes::lesser(Lanes::greater(code, Codes{} + 1), Codes{} + kGreatest) & (squared > 0);
}

inline std::uint8_t error_code(float squared) {
  return static_cast<std::uint8_t>(error_codes<16>(Simd<float, 16>::Numbers{} + squared)[0]);
}
inline std::uint8_t error_code(double squared) {
  if (!(squared > 0)) return 0;
  return error_code(static_cast<float>(std::clamp(squared, 1e-30, 1.0)));
}

/// Returns the code of the same error on the scale of an LOD this many LODs coarser: a scale's greatest error
/// doubles with each LOD.
constexpr std::uint8_t coarser_code(std::uint8_t code, int lods) {
  const int moved = code - 4 * lods;
  return static_cast<std::uint8_t>(code == 0 ? 0 : moved < 1 ? 1 : moved);
}

}  // namespace adamas::isosurface
