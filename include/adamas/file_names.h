#pragma once

#include <filesystem>
#include <string>

#include "adamas/export.h"

namespace adamas ADAMAS_API {

/// The extension in lower case, with its dot; the last two of a compressed file (".nii.gz").
std::string file_extension(const std::filesystem::path& path);

/// The name of a file without its file_extension.
std::string file_stem(const std::filesystem::path& path);

}  // namespace adamas
