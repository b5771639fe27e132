#pragma once

#include <string>
#include <vector>

#include "core/data/unstructured_mesh.h"
#include "interfaces/selection/saved_hierarchy.h"

namespace adamas::interfaces {

/// The format name of files of saved hierarchies, and its versions (docs/file_formats.md).
inline constexpr const char* kHierarchyFormat = "hierarchy";
inline constexpr int kHierarchyVersion = 2, kOldestHierarchyVersion = 1;

/// Converts a hierarchy to named arrays.
std::vector<NamedArray> to_arrays(const SavedHierarchy& hierarchy);

/// Converts arrays to a valid hierarchy; older versions lack some data. Throws Error that names `source` if
/// arrays are missing or have the wrong length, if indices are out of range, or if a law of the hierarchy is
/// broken.
SavedHierarchy from_arrays(const std::vector<NamedArray>& arrays, const std::string& source,
                           int version = kHierarchyVersion);

/// Converts the arrays with these names (names_of_tree_arrays()) to a hierarchy with no errors of diamonds
/// and of cells but the greatest ones: what whole_mesh() needs, a fraction of all bytes. Throws as
/// from_arrays() does, for what it has.
SavedHierarchy tree_from_arrays(const std::vector<NamedArray>& arrays, const std::string& source);
std::vector<std::string> names_of_tree_arrays();

/// Returns the names of all arrays of such a file; '#' stands for the number of a field.
std::vector<std::string> names_of_arrays();

}  // namespace adamas::interfaces
