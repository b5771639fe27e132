#pragma once

#include "adamas/volume_input.h"
#include "cli/command.h"

namespace adamas::cli {

/// Adds the options that say what files of bare samples hold. `origin`: the names of that for the first
/// sample; `subject`: what spacing and places are of.
void add_raw_options(const Command& command, RawOptions& options, const char* origin, const char* subject);

}  // namespace adamas::cli
