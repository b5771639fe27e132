#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "core/data/unstructured_mesh.h"

namespace adamas::io {

/// The number that VTK has for a type of cells with so many corners.
std::uint8_t vtk_cell_type(CellKind kind, std::size_t corners);

/// Writes a mesh as a VTKHDF file of version 1.0, type UnstructuredGrid, in one piece, compressed. '/' in the
/// names of arrays becomes " per ", since it would make groups. Throws Error if it is not written in full.
void write_vtkhdf(const std::filesystem::path& path, const UnstructuredMesh& mesh);

}  // namespace adamas::io
