#pragma once

#include <filesystem>

#include "adamas/progress.h"

namespace adamas::interfaces {
struct ResampledMesh;
struct SavedHierarchy;
}  // namespace adamas::interfaces

namespace adamas::workflow {

/// Whether a file is a hierarchy that adamas resample has saved; false where there is none.
bool is_saved_hierarchy(const std::filesystem::path& path);

/// Reads a saved hierarchy. Throws Error for another file, and for one that is damaged.
interfaces::SavedHierarchy load_saved_hierarchy(const std::filesystem::path& path, Progress& progress);

/// Reads a resampled mesh from .vtu, or the whole one from a saved hierarchy. Throws Error for another mesh.
interfaces::ResampledMesh load_resampled_mesh(const std::filesystem::path& path, Progress& progress);

}  // namespace adamas::workflow
