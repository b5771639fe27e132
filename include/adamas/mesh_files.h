#pragma once

#include <filesystem>

#include "adamas/cut_mesh.h"
#include "adamas/export.h"
#include "adamas/progress.h"
#include "adamas/resample.h"
#include "adamas/select.h"

namespace adamas ADAMAS_API {

// This header reads and writes files of adaptive meshes (docs/file_formats.md). All functions throw Error,
// with the file's name, where a file is missing, corrupt or cannot be written in full.

/// Writes a mesh with all its arrays: `.vtu`. The file is that of write_mesh(path, mesh.view()), but the
/// arrays are made for the file alone and not kept.
void write_mesh(const std::filesystem::path& path, const AdaptiveMesh& mesh);
/// Reads a mesh that write_mesh() or `adamas resample` has written, `.vtu`, or the finest mesh of a saved
/// hierarchy, `.h5`. Its report has only the name of the resampled input and the numbers of tetrahedra and
/// vertices.
AdaptiveMesh read_adaptive_mesh(const std::filesystem::path& path,
                                Progress& progress = SilentProgress::instance());
/// Writes a cut mesh with its fields and groups of faces: `.vtu`, `.msh` (Gmsh) or `.exo` (ExodusII).
void write_mesh(const std::filesystem::path& path, const CutMesh& mesh);
/// Writes the faces of a cut mesh between bodies and on the sides of the domain: `.vtp`.
void write_faces(const std::filesystem::path& path, const CutMesh& mesh);

/// Writes a hierarchy: `.h5`.
void write_hierarchy(const std::filesystem::path& path, const MultiresolutionMesh& mesh);
/// Reads a hierarchy that write_hierarchy() or `adamas resample --save` has written.
MultiresolutionMesh read_hierarchy(const std::filesystem::path& path,
                                   Progress& progress = SilentProgress::instance());

}  // namespace adamas
