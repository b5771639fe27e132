#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/io/grid_file.h"
#include "core/io/volume_source.h"

namespace adamas::io {

/// The greatest number of different labels.
inline constexpr std::size_t kMostLabels = 65535;

/// Reads the whole numbers of a source, one per sample, piece by piece as runs along x, so that memory
/// follows their changes. Sets `remark` if there is one on the file. Returns none if the source has
/// floating-point numbers, or more than kMostLabels different ones. Throws Error as VolumeReader and
/// unpack_volume do.
std::optional<WholeRuns> read_whole_runs(const VolumeSource& source, std::string& remark);

}  // namespace adamas::io
