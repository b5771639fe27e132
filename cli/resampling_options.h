#pragma once

#include <string>
#include <vector>

#include "adamas/resample.h"
#include "cli/command.h"
#include "cli/input_options.h"

namespace adamas::cli {

/// The options that say how well to resample.
void add_resampling_options(const Command& command, ResampleOptions& options);
/// These options without the interface error.
void add_other_resampling_options(const Command& command, ResampleOptions& options);
/// --field-error alone.
void add_field_error_option(const Command& command, std::vector<std::pair<std::string, ErrorTarget>>& errors);

}  // namespace adamas::cli
