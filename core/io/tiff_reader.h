#pragma once

#include <filesystem>

#include "core/io/grid_file.h"

namespace adamas {

/// The pages of a TIFF file as the z planes of one image; rows as stored, the first at y = 0; unit spacing.
/// VTK's own reader turns files of several pages into 8-bit RGBA. Not for the main process: libtiff may crash
/// on a corrupt file.
GridFile read_tiff_stack(const std::filesystem::path& path);

}  // namespace adamas
