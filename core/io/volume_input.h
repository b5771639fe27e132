#pragma once

#include <string>

#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/volume_input.h"
#include "core/io/volume_reader.h"

namespace adamas::io {

/// Opens a volume; outputs may not overwrite its files. `keep_scale`: see VolumeOptions. Throws Error
/// (kUsage) if values contradict each other, and Error as open_volume does.
VolumeReader open_volume_input(const VolumeInput& input, OutputSet& outputs, Progress& progress,
                               bool keep_scale = false);

/// Reads all planes of a volume into memory; messages call it `name`.
Volume read_whole(VolumeReader reader, const std::string& name, Progress& progress);

/// Whether a file has a format with nothing but the samples of one array, one number each; decided by its
/// name and, for NRRD, its header.
bool has_one_array(const std::string& path);

/// Whether a .vti says that its axes are not parallel to x, y and z, so that it is no grid laid out along
/// them.
bool is_aslant_image(const std::string& path);

}  // namespace adamas::io
