#pragma once

#include "adamas/volume_input.h"
#include "cli/command.h"

namespace adamas::cli {

/// Adds the options that describe files of bare samples. `origin`: the option names for the first sample;
/// `subject`: the word for the data that spacing and places belong to.
void add_raw_options(const Command& command, RawOptions& options, const char* origin, const char* subject);

}  // namespace adamas::cli
