#pragma once

#include <cstdint>
#include <filesystem>

namespace adamas {

/// Formats that a volume may come in, by who reads it.
enum class VolumeFormat : std::uint8_t { kNrrd, kMetaImage, kVti, kNifti, kHdf5, kTiff, kPng, kOtherGrid };

/// The format that a file's name ends in or, where that says nothing, that its first bytes show. Throws Error
/// that lists what is known where neither does.
VolumeFormat find_volume_format(const std::filesystem::path& path);

}  // namespace adamas
