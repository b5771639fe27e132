#pragma once

#include "adamas/volume_input.h"
#include "cli/command.h"
#include "cli/input_options.h"
#include "core/io/volume_input.h"

namespace adamas::cli {

/// Hands the options of bare samples over to the data on a grid where volume fractions or labels are named:
/// then they are those of a grid with materials.
void give_raw_options(VolumeInput& volume, InputArguments& input);

/// Opens a volume. Throws Error (kUsage) where options do not go together.
io::VolumeReader open_volume_input(const VolumeInput& input, Session& session);

}  // namespace adamas::cli
