#pragma once

#include <string>
#include <vector>

#include "core/io/volume_source.h"

namespace adamas::io {

/// Reads the texts of an array of a VTK file, each of which ends with a zero byte; the number of bytes is not
/// set in the source.
std::vector<std::string> read_texts(VolumeSource source);

}  // namespace adamas::io
