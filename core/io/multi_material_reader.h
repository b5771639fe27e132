#pragma once

#include <filesystem>
#include <optional>

#include "adamas/files.h"  // MaterialDataOptions
#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/data/multi_material_data.h"
#include "core/io/volume_reader.h"

namespace adamas::io {

/// The name of the one material of data without materials.
inline constexpr const char* kPlainMaterial = "volume";
/// Whether data have no materials.
bool is_plain(const MultiMaterialData& data);

/// Reads materials, fractions or labels, and fields from one file, or several, that read_grid_file can read.
/// Remaining arrays are fields, per material if the name says so ("Mass for Steel", "density_Steel"); "X
/// Velocity", "Y Velocity" and "Z Velocity" are one vector field; units in brackets are kept; arrays on the
/// other centering are averaged. Samples whose centering is not stated are taken as values of cells
/// (choose_centering), those of other files as they fit the main one. Materials of labels are named by their
/// value and sorted by it. `raw` describes files whose extensions belong to no format. Throws Error at
/// unusable files and at data that MultiMaterialData::normalise or check reject.
MultiMaterialData read_multi_material_data(const std::filesystem::path& path,
                                           const MaterialDataOptions& options = {},
                                           Progress& progress = SilentProgress::instance(),
                                           const std::optional<RawVolume>& raw = {});

}  // namespace adamas::io
