#pragma once

#include <filesystem>
#include <string>

namespace adamas::viewer {

/// The first name STEM-001, STEM-002 and so on, with this ending, that nothing in the folder has.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem,
                                const std::string& ending);

/// Gives a file or a folder such a name, in the folder where it is, and never that of something else, even if
/// that comes at the same time. Throws Error where that does not work. Returns the name.
std::filesystem::path rename_to_free_name(const std::filesystem::path& from, const std::string& stem,
                                          const std::string& ending);

}  // namespace adamas::viewer
