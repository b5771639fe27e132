#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "core/io/byte_supply.h"

namespace adamas::io {

/// Takes the next piece of decompressed bytes; returns false where no more are needed.
using ByteReceiver = std::function<bool(std::string_view)>;

/// Decompresses a zlib stream, or a gzip stream and those that follow it, and hands it out piece by piece.
/// Throws Error with `name` where it is corrupt or ends early; what follows its end is left alone, and so is
/// all that is behind what is wanted. Returns how many bytes it has handed out.
std::uint64_t inflate_stream(const ByteSupply& compressed, const std::string& name,
                             const ByteReceiver& receive);

/// The greatest ratio of decompressed to compressed bytes of a zlib stream.
inline constexpr std::uint64_t kGreatestInflation = 1032;

/// Decompresses a bzip2 stream and those that follow it, and hands them out piece by piece. Throws Error with
/// `name` where one is corrupt or ends early; what follows their end is left alone, and so is all that is
/// behind what is wanted. Returns how many bytes it has handed out.
std::uint64_t bunzip_stream(const ByteSupply& compressed, const std::string& name,
                            const ByteReceiver& receive);

/// The greatest ratio of decompressed to compressed bytes of a bzip2 stream: a block of 900 kB, in which 259
/// equal bytes are stored as five, takes 39 bytes or more.
inline constexpr std::uint64_t kGreatestBunzip = 2'000'000;

}  // namespace adamas::io
