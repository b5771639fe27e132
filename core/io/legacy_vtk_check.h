#pragma once

#include <filesystem>

namespace adamas {

/// Walks through a legacy binary VTK file on an image or rectilinear grid and throws Error where one of its
/// arrays reaches beyond the file's end, which VTK's reader does not report. Files of other kinds, and text
/// ones, pass.
void check_legacy_vtk(const std::filesystem::path& path);

}  // namespace adamas
