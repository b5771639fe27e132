#pragma once

#include <filesystem>
#include <string_view>

#include "core/io/grid_file.h"

namespace adamas::io {

/// The name of the format that read_dream3d() reads.
inline constexpr std::string_view kDream3d = "DREAM.3D";

/// Reads the arrays of cells on the first image geometry of a file of DREAM.3D, of its older form (groups of
/// data containers with _SIMPL_GEOMETRY) or of that of simplnx (a data structure with attributes of
/// geometries), in this process. The array "Phases" has the names of phases as those of its labels. Throws
/// Error, with the file's name, where there is no such geometry, where its sizes, spacing and origin are
/// missing or none, and where arrays are damaged.
GridFile read_dream3d(const std::filesystem::path& path);

}  // namespace adamas::io
