#pragma once

#include <filesystem>

#include "core/io/grid_file.h"

namespace adamas {

/// read_grid_file without its child process: on a corrupt file VTK may crash.
GridFile read_grid_with_vtk(const std::filesystem::path& path);

}  // namespace adamas
