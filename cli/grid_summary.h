#pragma once

#include "cli/console.h"
#include "cli/figures.h"
#include "core/io/file_summary.h"

namespace adamas {

// What is told of a file, on the console and as figures.

/// Numbers of points and cells, the box, axes and space.
void print_grid(const FileSummary& s, Console& console, Figures& figures);
/// A line for each array.
void print_arrays(const FileSummary& s, Console& console, Figures& figures);

}  // namespace adamas
