#pragma once

#include <filesystem>
#include <string>

namespace adamas::viewer {

/// The first name STEM-001, STEM-002 and so on, with this extension, that no file in the folder has.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& ending);

/// Renames a file or a folder to such a name in its own folder, and never replaces another file, even one
/// that appears at the same time. Returns the name. Throws Error if the file cannot be renamed.
std::filesystem::path rename_to_free_name(const std::filesystem::path& from, const std::string& stem,
                                          const std::string& ending);

}  // namespace adamas::viewer
