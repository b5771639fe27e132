#pragma once

#include <filesystem>
#include <vector>

namespace adamas::io {

/// The files that hold the samples of a header, or the other file of a NIfTI pair
/// (InputFormat::referred_files). Empty if a file is no such header or cannot be read. The files need not
/// exist.
std::vector<std::filesystem::path> referred_files(const std::filesystem::path& path);

/// The files that a header of NRRD (`data file`) or MetaImage (ElementDataFile) names: one, a list or a
/// pattern of names with numbers. Empty if it names none or cannot be read.
std::vector<std::filesystem::path> files_in_header(const std::filesystem::path& path);

}  // namespace adamas::io
