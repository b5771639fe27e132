#pragma once

#include <filesystem>

namespace adamas {

/// Opens an empty file in a folder for reading and writing that has no name, so that it is gone with its last
/// user, however that ends. Returns its descriptor, or -1, where errno tells why.
int open_unnamed_file(const std::filesystem::path& folder);

}  // namespace adamas
