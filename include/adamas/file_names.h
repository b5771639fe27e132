#pragma once

#include <filesystem>
#include <string>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// Returns the extension in lower case, with its dot; for a compressed file the last two extensions
/// (".nii.gz").
std::string file_extension(const std::filesystem::path& path);

/// Returns the name of a file without its file_extension().
std::string file_stem(const std::filesystem::path& path);

}  // namespace adamas
