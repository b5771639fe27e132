#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/figures.h"
#include "core/io/file_summary.h"
#include "core/io/volume_reader.h"

namespace adamas::cli {

// What is told of files, volumes and stores: printed on the console, and as figures for `--json`.

/// A line on the box and the spacing of a volume, and those of print_axes.
void print_places(const VolumeGrid& grid, Console& console);
/// A line on the axes where they are not x, y and z in this order, and one on the space, where it has a name.
void print_axes(const VolumeGrid& grid, Console& console);

/// The same as figures: `box`, `spacing`, `origin` (of the first sample), `directions` (unit vectors of the
/// axes), `space` (null where nothing says).
void add_places(const VolumeGrid& grid, Figures& figures);

/// Numbers of points and cells, the box, axes and space.
void print_grid(const io::FileSummary& s, Console& console, Figures& figures);
/// A line for each array.
void print_arrays(const io::FileSummary& s, Console& console, Figures& figures);

/// How many steps there are and when: "6 steps, times from 0 to 1, 0.2 apart"; times that are not evenly
/// spaced, to a millionth of the mean distance, are named, the first and the last ones of many.
std::string times_text(const std::vector<double>& times);

/// What is in a volume, which is read plane by plane. `array`: its name, or empty for that of the file.
Figures print_volume(io::VolumeReader reader, const std::string& path, const std::string& array,
                     Session& session);

/// What a store is, as `info` tells it.
Figures print_store(const std::string& path, Session& session);

}  // namespace adamas::cli
