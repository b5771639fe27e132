#pragma once

#include "adamas/resample.h"
#include "cli/console.h"

namespace adamas::cli {

/// Prints the result of a run of the resampler, and notes the errors that it did not reach.
void print_resampled(const ResampleReport& report, Console& console);

}  // namespace adamas::cli
