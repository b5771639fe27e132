#pragma once

#include <optional>

#include "adamas/output_set.h"
#include "adamas/progress.h"
#include "adamas/volume_input.h"
#include "core/io/volume_reader.h"

namespace adamas::workflow {

/// Opens the volume of a file, if the file is to be read as a volume: where `volume` says so, and where no
/// other reader knows the file or any option about places; otherwise none. `grid_wanted`: options say that
/// the file is data on a grid with materials. No output may overwrite the files of the volume then.
std::optional<io::VolumeReader> find_volume(const VolumeInput& volume, bool grid_wanted, OutputSet& outputs,
                                            Progress& progress);

}  // namespace adamas::workflow
