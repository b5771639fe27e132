#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/io/byte_supply.h"

namespace adamas::io {

/// Receives the next piece of decompressed bytes; returns false when no more are needed.
using ByteReceiver = std::function<bool(std::string_view)>;

/// Decompresses a zlib stream, or a gzip stream and those that follow it, and passes it on piece by piece.
/// Throws Error with `name` if it is corrupt or ends early. Bytes behind its end, and behind what the
/// receiver needs, are not read. Returns how many bytes were passed on.
std::uint64_t inflate_stream(const ByteSupply& compressed, const std::string& name,
                             const ByteReceiver& receive);

/// The same for a deflate stream without a header. Throws Error too if all of its bytes are passed on and
/// their CRC-32 is not `checksum`.
std::uint64_t inflate_raw_stream(const ByteSupply& compressed, std::uint32_t checksum,
                                 const std::string& name, const ByteReceiver& receive);

/// The greatest ratio of decompressed to compressed bytes of a zlib stream.
inline constexpr std::uint64_t kGreatestInflation = 1032;

/// Decompresses a bzip2 stream and those that follow it, and passes them on piece by piece. Throws Error with
/// `name` if one is corrupt or ends early. Bytes behind their end, and behind what the receiver needs, are
/// not read. Returns how many bytes were passed on.
std::uint64_t bunzip_stream(const ByteSupply& compressed, const std::string& name,
                            const ByteReceiver& receive);

/// The greatest ratio of decompressed to compressed bytes of a bzip2 stream: a block of 900 kB, in which 259
/// equal bytes are stored as five, takes 39 bytes or more.
inline constexpr std::uint64_t kGreatestBunzip = 2'000'000;

}  // namespace adamas::io
