#pragma once

#include <string>
#include <vector>

#include "cli/console.h"
#include "interfaces/resampling/resample_figures.h"

namespace adamas::cli {

/// Prints what a run of the resampler came to, and notes what it did not reach.
void print_resampled(const interfaces::ResampleFigures& measured, const interfaces::Resampler& resampler,
                     Console& console);
/// The notes alone.
void note_resampled(const interfaces::ResampleFigures& measured, const interfaces::Resampler& resampler,
                    Console& console);

/// One line that says which error was not reached, and why.
std::string unreached_text(const interfaces::UnreachedError& error);

/// Such lines of everything that was wanted and not reached, volumes too: of those of all bodies, or of the
/// worst one, which tells how many more there are.
std::vector<std::string> unreached_lines(const interfaces::ResampleFigures& measured,
                                         const interfaces::Resampler& resampler, bool all_bodies = true);

}  // namespace adamas::cli
