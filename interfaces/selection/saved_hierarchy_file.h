#pragma once

#include <string>
#include <vector>

#include "core/data/unstructured_mesh.h"
#include "interfaces/selection/saved_hierarchy.h"

namespace adamas::interfaces {

/// The format name of files of saved hierarchies, and its versions (docs/file_formats.md).
inline constexpr const char* kHierarchyFormat = "hierarchy";
inline constexpr int kHierarchyVersion = 2, kOldestHierarchyVersion = 1;

/// The hierarchy as named arrays.
std::vector<NamedArray> to_arrays(const SavedHierarchy& hierarchy);

/// Makes the arrays a hierarchy again, which is valid; an older version lacks some of it. Throws Error,
/// naming `source`, where arrays are missing, of the wrong length, or point outside, and where a law of the
/// hierarchy is broken.
SavedHierarchy from_arrays(const std::vector<NamedArray>& arrays, const std::string& source,
                           int version = kHierarchyVersion);

/// The names of all arrays that such a file has; '#' stands for the number of a field.
std::vector<std::string> names_of_arrays();

}  // namespace adamas::interfaces
