#include "core/base/checksum.h"

#include <array>
#include <cstring>

namespace adamas::inline core {

namespace {

/// The remainder of each byte, for computing the checksum byte by byte.
constexpr auto kTable = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit) remainder = remainder >> 1 ^ ((remainder & 1) != 0 ? 0x82f63b78u : 0u);
    table[byte] = remainder;
  }
  return table;
}();

std::uint32_t take_bytes(std::uint32_t crc, std::span<const std::byte> bytes) {
  for (const std::byte byte : bytes)
    crc = crc >> 8 ^ kTable[(crc ^ std::to_integer<std::uint32_t>(byte)) & 0xff];
  return crc;
}

#if defined(__x86_64__)
/// Adds whole words of eight bytes to a checksum, by the processor's instruction for this polynomial; bytes
/// behind the last whole word are left out.
[[gnu::target("sse4.2")]] std::uint32_t take_words(std::uint32_t crc, std::span<const std::byte> bytes) {
  for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, 8);
    crc = static_cast<std::uint32_t>(__builtin_ia32_crc32di(crc, word));
  }
  return crc;
}
#endif

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before) {
  std::uint32_t crc = ~before;
#if defined(__x86_64__)
  static const bool kHasInstruction = __builtin_cpu_supports("sse4.2") != 0;
  if (kHasInstruction) {
    crc = take_words(crc, bytes);
    bytes = bytes.last(bytes.size() % 8);
  }
#endif
  return ~take_bytes(crc, bytes);
}

}  // namespace adamas::inline core
