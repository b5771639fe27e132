#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace adamas {

/// The code on the ErrorScale of an LOD, from the square of the error's ratio to the scale's greatest error.
/// Rounds up, also what rounding may have taken off `squared`: by 2^-20 at most. 0 for 0 alone.
inline std::uint8_t error_code(float squared) {
  if (!(squared > 0)) return 0;
  // Codes are quarters of octaves of the error, so halves of octaves of its square.
  constexpr std::uint32_t kRootOfTwo = 0x3504f3;  // its mantissa, rounded down
  const auto bits = std::bit_cast<std::uint32_t>(std::min(squared, 1.0f) * (1 + 0x1p-20f));
  const int exponent = static_cast<int>(bits >> 23) - 127;
  const int code = 64 + 2 * exponent + ((bits & 0x7fffffu) > kRootOfTwo ? 1 : 0);
  return static_cast<std::uint8_t>(std::clamp(code, 1, 63));
}
inline std::uint8_t error_code(double squared) {
  if (!(squared > 0)) return 0;
  return error_code(static_cast<float>(std::clamp(squared, 1e-30, 1.0)));
}

/// The code, on the scale of an LOD this many LODs coarser, of the same error: a scale's greatest error
/// doubles with each LOD.
constexpr std::uint8_t coarser_code(std::uint8_t code, int lods) {
  const int moved = code - 4 * lods;
  return static_cast<std::uint8_t>(code == 0 ? 0 : moved < 1 ? 1 : moved);
}

}  // namespace adamas
