#pragma once

#include <filesystem>

#include "core/data/unstructured_mesh.h"

namespace adamas::io {

/// Writes .vtu or .vtp (only polygons and lines), binary and compressed; equal meshes give equal bytes.
/// Throws Error if the mesh does not suit the extension or the file cannot be written in full.
void write_unstructured_mesh(const std::filesystem::path& path, const UnstructuredMesh& mesh);
/// Writes a mesh, whose arrays are freed as soon as they are converted.
void write_unstructured_mesh(const std::filesystem::path& path, UnstructuredMesh&& mesh);

/// Reads .vtu or .vtp with cells of one kind: tetrahedra, polygons (including triangles and quadrilaterals)
/// or lines. Arrays of other types become int32 if their values are whole and fit, else double. Throws Error,
/// with the file's name, at corrupt files, indices out of range and other cells.
UnstructuredMesh read_unstructured_mesh(const std::filesystem::path& path);

}  // namespace adamas::io
