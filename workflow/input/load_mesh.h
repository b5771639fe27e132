#pragma once

#include <filesystem>

#include "adamas/progress.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::interfaces {
struct SavedHierarchy;
}  // namespace adamas::interfaces

namespace adamas::workflow {

/// Returns whether a file is a hierarchy that adamas resample has saved; false where there is no file.
bool is_saved_hierarchy(const std::filesystem::path& path);

/// Reads a saved hierarchy. Throws Error for another file, and for a damaged one.
interfaces::SavedHierarchy load_saved_hierarchy(const std::filesystem::path& path, Progress& progress);

/// Reads the tree of a saved hierarchy, which has the finest mesh (tree_from_arrays()). Throws as
/// load_saved_hierarchy() does.
interfaces::SavedHierarchy load_saved_tree(const std::filesystem::path& path, Progress& progress);

/// Reads a resampled mesh from .vtu, or the finest mesh of a saved hierarchy. Throws Error for another mesh.
interfaces::ResampledMesh load_resampled_mesh(const std::filesystem::path& path, Progress& progress);

}  // namespace adamas::workflow
