#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace adamas::picture {

/// File formats of pictures.
enum class PictureFormat { kPng, kSvg, kPdf };

/// The format by the extension (.png, .svg, .pdf, in any case); throws Error for another one.
PictureFormat picture_format(const std::filesystem::path& path);

/// A file's extension in lower case.
std::string lower_extension(const std::filesystem::path& path);

/// Writes bytes to a file through OutputFile; throws Error if they cannot all be written.
void write_bytes(const std::filesystem::path& path, std::string_view bytes);

}  // namespace adamas::picture
