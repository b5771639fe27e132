#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace adamas::inline core {

/// CRC-32C (Castagnoli; RFC 3720, B.4), which finds every change of up to 32 bits in a row. `before`: the
/// checksum of bytes that come before these.
std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before = 0);

}  // namespace adamas::inline core
