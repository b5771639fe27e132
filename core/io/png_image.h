#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace adamas::io {

/// A gray picture of 8 or 16 bits.
struct PngImage {
  std::uint32_t width = 0, height = 0;
  int bits = 8;
  std::vector<std::byte> samples;  ///< rows from the top, in the machine's byte order
};

/// Reads a gray picture. Throws Error that names the file for other pictures and for what is no complete PNG.
/// Only the reader process calls it, since a library reads the file.
PngImage read_png(const std::filesystem::path& path);

/// Checks a PNG of any colours: throws Error unless it is complete, since VTK crashes on such a file.
void check_png(const std::filesystem::path& path);

}  // namespace adamas::io
