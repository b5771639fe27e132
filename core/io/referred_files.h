#pragma once

#include <filesystem>
#include <vector>

namespace adamas {

/// The files that hold the samples of a header: of .nhdr and .nrrd (`data file`, a list or a pattern of names
/// too), of .mhd and .mha (ElementDataFile, the same), and of a NIfTI pair the other one. Nothing of a file
/// that is no such header or cannot be read; whether they exist is not looked at.
std::vector<std::filesystem::path> referred_files(const std::filesystem::path& path);

}  // namespace adamas
