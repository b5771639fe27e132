#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace adamas::io {

/// Size in bytes of a file to read. Throws Error where it is missing, a folder, not a plain file, unreadable,
/// empty.
std::size_t check_input_file(const std::filesystem::path& path);

/// Lower-case extension with its dot; the last two for what is compressed (".nii.gz").
std::string file_extension(const std::filesystem::path& path);

/// File name without file_extension.
std::string file_stem(const std::filesystem::path& path);

/// The whole content of a checked input file.
std::string read_file(const std::filesystem::path& path);

/// Room for any header of those that precede data.
inline constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

/// The first kLongestHeader bytes of a checked input file, or all of them.
std::string read_beginning(const std::filesystem::path& path);

}  // namespace adamas::io
