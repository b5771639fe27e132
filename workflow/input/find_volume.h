#pragma once

#include <optional>

#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/volume_input.h"
#include "core/io/volume_reader.h"

namespace adamas::workflow {

/// Opens the volume that a file is, if it is to be read as one: where `volume` says so, and where no other
/// reader knows it or all that it may say of places; otherwise none. `grid_wanted`: options say that the file
/// is data on a grid with materials. No output may overwrite the files of the volume then.
std::optional<io::VolumeReader> find_volume(const VolumeInput& volume, bool grid_wanted, OutputSet& outputs,
                                            Progress& progress);

}  // namespace adamas::workflow
