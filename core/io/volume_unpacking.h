#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/base/progress.h"
#include "core/io/volume_source.h"

namespace adamas {

/// Unpacks the samples of a packed source into a scratch file in `folder` and returns the source that reads
/// them there. Throws Error where they are corrupt or not as many as the header says, or the disk is full;
/// Cancelled.
VolumeSource unpack_volume(VolumeSource source, const std::filesystem::path& folder, Progress& progress);
/// The same into an empty scratch file.
VolumeSource unpack_into(std::shared_ptr<FileHandle> scratch, const VolumeSource& source, Progress& progress);

/// How many bytes an array of a VTK file has by what stands before it or, where it is text, by counting; of
/// the source's grid nothing is looked at.
std::uint64_t measure_vtk_array(const VolumeSource& source);

}  // namespace adamas
