#pragma once

#include "adamas/read_input.h"
#include "core/data/mesh_data.h"
#include "core/data/multi_material_data.h"

namespace adamas::workflow {

/// Throws Error where the headers of the files show that reading the grid, and reconstructing interfaces of
/// as few mixed cells as there may be, takes more memory than `options.memory`. It reads no samples, and
/// returns where a header does not say how many cells there are.
void check_memory_of_headers(const InputOptions& options);

/// Throws Error where reconstructing the interfaces of the data takes more memory than `options.memory`, by
/// an estimate from the numbers of cells and of places where materials meet.
void check_memory_of_data(const InputOptions& options, const MultiMaterialData& data);

/// Throws Error where the header of a mesh of cells (.vtu, .vts, legacy .vtk, ExodusII of netCDF) shows that
/// reading it takes more memory than `options.memory`. It returns where a header does not say how many cells
/// or points there are.
void check_memory_of_mesh_header(const InputOptions& options);

/// Throws Error where reconstructing the interfaces of data on a mesh takes more memory than
/// `options.memory`, by an estimate from the numbers of cells, faces and points and of places where materials
/// meet.
void check_memory_of_mesh(const InputOptions& options, const MeshData& data);

}  // namespace adamas::workflow
