#pragma once

#include <string>
#include <vector>

#include "adamas/resample.h"
#include "cli/command.h"
#include "cli/input_options.h"

namespace adamas::cli {

/// Adds the options that say how well to resample.
void add_resampling_options(const Command& command, ResampleOptions& options);
/// Adds these options without the interface error.
void add_other_resampling_options(const Command& command, ResampleOptions& options);
/// Adds --field-error alone.
void add_field_error_option(const Command& command, std::vector<std::pair<std::string, ErrorTarget>>& errors);

}  // namespace adamas::cli
