#pragma once

#include <filesystem>
#include <vector>

namespace adamas::io {

/// The files that hold the samples of a header, and of a NIfTI pair the other one
/// (InputFormat::referred_files). Nothing of a file that is no such header or cannot be read; whether they
/// exist is not looked at.
std::vector<std::filesystem::path> referred_files(const std::filesystem::path& path);

/// Those that a header of NRRD (`data file`) or MetaImage (ElementDataFile) names, one, a list of them or a
/// pattern of names with numbers; nothing where there are none or the file cannot be read.
std::vector<std::filesystem::path> files_in_header(const std::filesystem::path& path);

}  // namespace adamas::io
