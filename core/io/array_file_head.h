#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>

namespace adamas::io {

inline constexpr std::size_t kArrayFileHeadBytes = 512;

/// The first line of a file of arrays.
inline std::string array_file_line(const std::string& format) { return "adamas " + format + "\n"; }

/// The head of a file of arrays, which precedes `bytes` bytes of HDF5 with this checksum.
inline std::string array_file_head(const std::string& format, int version, std::size_t bytes,
                                   std::uint32_t checksum) {
  std::string head = array_file_line(format) + fmt::format("version {}\nbytes {}\ncrc32c {:08x}\n", version,
                                                           kArrayFileHeadBytes + bytes, checksum);
  head.resize(kArrayFileHeadBytes, '\0');
  return head;
}

/// The greatest number of bytes that the arrays in a file of that size may have; data never compress more
/// than that.
inline std::uint64_t most_array_bytes(std::uint64_t file_bytes) {
  constexpr std::uint64_t kGreatestExpansion = 256, kSmall = std::uint64_t{1} << 20;
  return kSmall + kGreatestExpansion * file_bytes;
}

}  // namespace adamas::io
