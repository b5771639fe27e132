#include "workflow/input/saved_hierarchy.h"

#include "core/io/array_file.h"
#include "core/io/input_file.h"
#include "interfaces/selection/saved_hierarchy_file.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace io;

bool is_saved_hierarchy(const std::filesystem::path& path) {
  return file_extension(path) == ".h5" && is_array_file(path, kHierarchyFormat);
}

SavedHierarchy load_saved_hierarchy(const std::filesystem::path& path, Progress& progress) {
  check_input_file(path);
  progress.step("reading " + path.string(), -1);
  const ArrayFile file =
      read_array_file(path, kHierarchyFormat, names_of_arrays(), kOldestHierarchyVersion, kHierarchyVersion);
  return from_arrays(file.arrays, path.string(), file.version);
}

}  // namespace adamas::workflow
