#pragma once

#include <bit>
#include <cstdint>

#include "isosurface/compression/bit_stream.h"

namespace adamas {

// Codes of numbers from 1 on, of any size (Elias 1975).

/// A number of 1 to 2^16 - 1 in twice as many bits as it has, less one.
inline void put_gamma(BitWriter& out, std::uint32_t value) {
  const auto bits = static_cast<int>(std::bit_width(value));
  out.put(1u << (bits - 1), bits);
  out.put(value & ((1u << (bits - 1)) - 1), bits - 1);
}

/// 0 where there is no such number.
inline std::uint32_t take_gamma(BitReader& in) {
  in.refill();
  const int bits = std::countr_zero(in.window() | 1u << 16) + 1;
  if (bits > 16) return 0;
  in.skip(bits);
  return 1u << (bits - 1) | static_cast<std::uint32_t>(in.take(bits - 1));
}

/// A number below 2^kMostDeltaBits by a gamma code of how many bits it has, and all but the first of these.
inline constexpr int kMostDeltaBits = 56;

inline void put_delta(BitWriter& out, std::uint64_t value) {
  const auto bits = static_cast<int>(std::bit_width(value));
  put_gamma(out, static_cast<std::uint32_t>(bits));
  out.put(value & ((std::uint64_t{1} << (bits - 1)) - 1), bits - 1);
}

/// 0 where there is no such number.
inline std::uint64_t take_delta(BitReader& in) {
  const std::uint32_t bits = take_gamma(in);
  if (bits == 0 || bits > kMostDeltaBits) return 0;
  in.refill();
  return std::uint64_t{1} << (bits - 1) | in.take(static_cast<int>(bits) - 1);
}

}  // namespace adamas
