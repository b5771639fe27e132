#pragma once

#include <string>
#include <vector>

#include "adamas/summary.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

// The functions below print facts about files, volumes and stores on the console, and return them as figures
// for `--json`.

/// Prints a line on the box and the spacing of a volume, and those of print_axes().
void print_places(const VolumeGrid& grid, Console& console);
/// Prints a line on the axes where they are not x, y and z in this order, and one on the space, where it has
/// a name.
void print_axes(const VolumeGrid& grid, Console& console);

/// Adds these facts to figures: `box`, `spacing`, `origin` (of the first sample), `directions` (unit vectors
/// of the axes), `space` (null where it is not known).
void add_places(const VolumeGrid& grid, Figures& figures);

/// Prints numbers of points and cells, the box, axes and space.
void print_grid(const FileSummary& s, Console& console, Figures& figures);
/// Prints a line for each array.
void print_arrays(const FileSummary& s, Console& console, Figures& figures);

/// Returns a text of the number of steps and their times: "6 steps, times from 0 to 1, 0.2 apart". Times that
/// are not evenly spaced, to a millionth of the mean distance, are listed, of many the first and the last
/// ones.
std::string times_text(const std::vector<double>& times);

/// Prints a summary of a volume.
Figures print_volume(const VolumeSummary& volume, const std::string& path, Console& console);

/// Prints a summary of a store for `info`.
Figures print_store(const std::string& path, Session& session);

}  // namespace adamas::cli
