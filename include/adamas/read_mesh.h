#pragma once

#include <filesystem>

#include "adamas/progress.h"
#include "adamas/resample.h"

namespace adamas {

/// Reads a mesh that `adamas resample` has written: a `.vtu`, or a saved hierarchy (`.h5`), of which it is
/// the finest mesh. Of its report, the name of the resampled input and the numbers of tetrahedra and vertices
/// are known. Throws Error, with the file's name, where the file is missing, damaged or holds another mesh.
AdaptiveMesh read_adaptive_mesh(const std::filesystem::path& path,
                                Progress& progress = SilentProgress::instance());

}  // namespace adamas
