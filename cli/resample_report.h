#pragma once

#include <string>
#include <vector>

#include "adamas/resample.h"
#include "cli/console.h"

namespace adamas::cli {

/// Prints what a run of the resampler came to, and notes what it did not reach.
void print_resampled(const ResampleReport& report, Console& console);
/// Notes what a run did not reach, and bodies and materials that the mesh shows changed or not at all.
void note_resampled(const ResampleReport& report, Console& console);

/// One line that says which error was not reached, and why.
std::string unreached_text(const UnreachedError& error);

/// Lines of this kind for everything that was wanted and not reached, volumes too: those of all bodies, or of
/// the worst one, which says how many more there are.
std::vector<std::string> unreached_lines(const ResampleReport& report, bool all_bodies = true);

}  // namespace adamas::cli
