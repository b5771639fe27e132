#pragma once

#include "cli/console.h"
#include "cli/figures.h"
#include "core/data/volume.h"

namespace adamas {

/// A line on the box and the spacing of a volume, and those of print_axes.
void print_places(const VolumeGrid& grid, Console& console);
/// A line on the axes where they are not x, y and z in this order, and one on the space, where it has a name.
void print_axes(const VolumeGrid& grid, Console& console);

/// The same as figures: `box`, `spacing`, `origin` (of the first sample), `directions` (unit vectors of the
/// axes), `space` (null where nothing says).
void add_places(const VolumeGrid& grid, Figures& figures);

}  // namespace adamas
