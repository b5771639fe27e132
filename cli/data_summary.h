#pragma once

#include <string>
#include <vector>

#include "adamas/summary.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

// What is told of files, volumes and stores: printed on the console, and as figures for `--json`.

/// Numbers of points and cells, the box, axes and space.
void print_grid(const FileSummary& s, Console& console, Figures& figures);
/// A line for each array.
void print_arrays(const FileSummary& s, Console& console, Figures& figures);

/// How many steps there are and when: "6 steps, times from 0 to 1, 0.2 apart"; times that are not evenly
/// spaced, to a millionth of the mean distance, are named, the first and the last ones of many.
std::string times_text(const std::vector<double>& times);

/// Prints what is in a volume.
Figures print_volume(const VolumeSummary& volume, const std::string& path, Console& console);

/// What a store is, as `info` tells it.
Figures print_store(const std::string& path, Session& session);

}  // namespace adamas::cli
