#pragma once

#include <filesystem>

#include "adamas/progress.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::workflow {

/// Reads a resampled mesh from .vtu, or the finest mesh of a saved hierarchy. Throws Error for another mesh.
interfaces::ResampledMesh load_resampled_mesh(const std::filesystem::path& path, Progress& progress);

}  // namespace adamas::workflow
