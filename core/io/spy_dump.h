#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/io/mesh_file.h"

namespace adamas::io {

/// Whether a file is a dump of CTH ("spy", of ParaView's reader SPCTH), by its first bytes, or a list of such
/// (.spcth-timeseries).
bool is_spy_dump(const std::filesystem::path& path);

/// Reads the cells of a dump of CTH, at a time as read_mesh_file does: each processor has written a file,
/// whose name ends in its number, and all of them are read, whichever is named. A list of dumps names one
/// file of each, in the order of their times; a later dump takes the place of the times of earlier ones from
/// its first one on, as where a run was started again.
///
/// Blocks of cells of several levels share faces (add_amr_cells); the layer of cells round each, a copy of
/// others, is left out. Fractions are arrays "Volume fraction of material N", values per material "NAME for
/// material N (UNIT)", and what the materials leave is "Void volume fraction", unless the file has that.
/// Throws Error, with the name of the file, if one is missing or damaged, or if they are of different runs.
MeshFile read_spy_dump(const std::filesystem::path& path, std::optional<std::uint64_t> time = {});
/// The times of a dump, or of all dumps of a list (mesh_times()).
std::vector<double> spy_dump_times(const std::filesystem::path& path);

}  // namespace adamas::io
