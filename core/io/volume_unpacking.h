#pragma once

#include <filesystem>

#include "core/base/progress.h"
#include "core/io/volume_source.h"

namespace adamas {

/// Unpacks the samples of a packed source into a scratch file in `folder` and returns the source that reads
/// them there. Throws Error where they are corrupt or not as many as the header says, or the disk is full;
/// Cancelled.
VolumeSource unpack_volume(VolumeSource source, const std::filesystem::path& folder, Progress& progress);

}  // namespace adamas
