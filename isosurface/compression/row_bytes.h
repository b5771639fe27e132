#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace adamas {

/// Eight bytes of a row of cells, worked on together; that of the first cell lowest.
using RowBytes = std::uint64_t;

constexpr RowBytes kEachByte = 0x0101010101010101u;

[[gnu::always_inline]] inline RowBytes load_row(const std::uint8_t* from) {
  RowBytes bytes;
  std::memcpy(&bytes, from, sizeof bytes);
  if constexpr (std::endian::native == std::endian::big) bytes = __builtin_bswap64(bytes);
  return bytes;
}
[[gnu::always_inline]] inline void store_row(RowBytes bytes, std::uint8_t* to) {
  if constexpr (std::endian::native == std::endian::big) bytes = __builtin_bswap64(bytes);
  std::memcpy(to, &bytes, sizeof bytes);
}

/// All bits of the first `count` bytes, 0 to 8.
constexpr RowBytes first_bytes(int count) {
  return count >= 8 ? ~RowBytes{0} : (RowBytes{1} << 8 * count) - 1;
}
/// All bits of the bytes that are not 0.
[[gnu::always_inline]] inline RowBytes bytes_not_zero(RowBytes bytes) {
  constexpr RowBytes kLow = kEachByte * 127;
  return ((((bytes & kLow) + kLow) | bytes) >> 7 & kEachByte) * 255;
}
/// How many bytes have all bits, the others having none.
[[gnu::always_inline]] inline std::size_t bytes_in(RowBytes mask) {
  // The uppermost byte of the product is the sum of all.
  return static_cast<std::size_t>((mask & kEachByte) * kEachByte >> 56);
}

/// The bytes that a mask has, side by side from the lowest on. Wide: see with_wide_lanes.
template <bool Wide>
[[gnu::always_inline]] inline RowBytes gather_bytes(RowBytes bytes, RowBytes mask) {
#if defined(__x86_64__)
  if constexpr (Wide) {
    // The compiler's own function for it cannot be inlined where the target is chosen at run time.
    RowBytes result;
    __asm__("pext %2, %1, %0" : "=r"(result) : "r"(bytes), "r"(mask));
    return result;
  }
#endif
  RowBytes result = 0;
  for (int n = 0, to = 0; n < 64; n += 8) {
    if ((mask >> n & 1) == 0) continue;
    result |= (bytes >> n & 255) << to;
    to += 8;
  }
  return result;
}
/// The inverse: 0 in the bytes that the mask does not have.
template <bool Wide>
[[gnu::always_inline]] inline RowBytes spread_bytes(RowBytes bytes, RowBytes mask) {
#if defined(__x86_64__)
  if constexpr (Wide) {
    RowBytes result;
    __asm__("pdep %2, %1, %0" : "=r"(result) : "r"(bytes), "r"(mask));
    return result;
  }
#endif
  RowBytes result = 0;
  for (int n = 0; n < 64; n += 8) {
    if ((mask >> n & 1) == 0) continue;
    result |= (bytes & 255) << n;
    bytes >>= 8;
  }
  return result;
}

}  // namespace adamas
