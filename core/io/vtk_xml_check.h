#pragma once

#include <filesystem>

namespace adamas {

/// What VTK does not report about a .vti or .vtr: throws Error where the pieces' extents are not within the
/// whole one or leave some of it out, where the extents are of more points than the file's bytes can be
/// values of, and where an array lies at no place of the file.
void check_vtk_xml(const std::filesystem::path& path);

}  // namespace adamas
