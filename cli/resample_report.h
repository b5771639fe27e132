#pragma once

#include "cli/console.h"
#include "interfaces/resampling/resample_figures.h"

namespace adamas {

/// Prints what a run of the resampler came to, and notes what it did not reach.
void print_resampled(const ResampleFigures& measured, const Resampler& resampler, Console& console);
/// The notes alone.
void note_resampled(const ResampleFigures& measured, const Resampler& resampler, Console& console);

}  // namespace adamas
