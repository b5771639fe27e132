#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/data/multi_material_data.h"

namespace adamas {

/// Writes .vtr, or .vti where the nodes are evenly spaced, for read_multi_material_data: arrays "Volume
/// Fraction for NAME", "FIELD for NAME [unit]" per material and "FIELD [unit]" mixed, or the array "labels"
/// of indices into the field array "material_names". Equal data give equal bytes. Throws Error where the grid
/// does not suit the extension or the file cannot be written in full.
void write_multi_material_data(const std::filesystem::path& path, const MultiMaterialData& data);

/// One step of a series: its time, and its file's name as seen from the series' folder.
struct SeriesEntry {
  double time = 0;
  std::string file;
};

/// Writes a .pvd, the list of files that ParaView and VisIt read as a series. Throws Error where it cannot be
/// written in full.
void write_series(const std::filesystem::path& path, const std::vector<SeriesEntry>& entries);

}  // namespace adamas
