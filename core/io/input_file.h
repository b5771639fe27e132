#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "adamas/file_names.h"

namespace adamas::io {

/// The size in bytes of a file to read; of an OpenFOAM case (.foam) that of all files in its folder. Throws
/// Error if it is missing, a folder, no regular file, unreadable or empty.
std::size_t check_input_file(const std::filesystem::path& path);
/// The bytes of all files in a folder and below it.
std::uintmax_t size_of_folder(const std::filesystem::path& folder);
/// Whether a path that no file has is a pattern of names (match_stack).
bool is_file_pattern(const std::filesystem::path& path);

/// The whole content of a checked input file.
std::string read_file(const std::filesystem::path& path);

/// The longest header that is read, in bytes.
inline constexpr std::size_t kLongestHeader = std::size_t{1} << 20;

/// The first kLongestHeader bytes of a checked input file, or all of them.
std::string read_beginning(const std::filesystem::path& path);

}  // namespace adamas::io
