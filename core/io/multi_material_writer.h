#pragma once

#include <filesystem>

#include "core/data/multi_material_data.h"

namespace adamas::io {

/// Writes .vtr, or .vti if the nodes are evenly spaced, for read_multi_material_data: arrays "Volume Fraction
/// for NAME", "FIELD for NAME [unit]" per material and "FIELD [unit]" for mixed fields, or the array "labels"
/// of indices into the field array "material_names". Equal data give equal bytes. Throws Error if the grid
/// does not suit the extension or the file cannot be written in full.
void write_multi_material_data(const std::filesystem::path& path, const MultiMaterialData& data);

}  // namespace adamas::io
