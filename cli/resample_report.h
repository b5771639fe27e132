#pragma once

#include "adamas/resample.h"
#include "cli/console.h"

namespace adamas::cli {

/// Prints what a run of the resampler came to, and notes what it did not reach.
void print_resampled(const ResampleReport& report, Console& console);

}  // namespace adamas::cli
