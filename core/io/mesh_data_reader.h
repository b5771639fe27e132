#pragma once

#include <filesystem>

#include "adamas/files.h"  // MaterialDataOptions
#include "adamas/progress.h"
#include "core/data/mesh_data.h"

namespace adamas::io {

/// Reads materials, fractions or labels, and fields from a mesh of any file that read_mesh_file can read, as
/// read_multi_material_data does for grids. Where neither options nor names of arrays say what the materials
/// are, blocks are materials. Fractions and labels are of cells; those of points are averaged, or refused.
MeshData read_mesh_data(const std::filesystem::path& path, const MaterialDataOptions& options = {},
                        Progress& progress = SilentProgress::instance());

}  // namespace adamas::io
