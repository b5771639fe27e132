#pragma once

#include <filesystem>

#include "adamas/meshes.h"

namespace adamas::io {

/// Reads a surface, with the normals and values of a .ply that write_surface wrote or of a .vtp, or points
/// and triangles alone of another .ply, an .obj, .off or .stl. Polygons are divided into triangles. Throws
/// Error, with the file's name, at corrupt files and other formats.
TriangleSurface read_triangle_surface(const std::filesystem::path& path);

}  // namespace adamas::io
