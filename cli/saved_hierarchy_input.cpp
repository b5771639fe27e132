#include "cli/saved_hierarchy_input.h"

#include "core/io/array_file.h"
#include "core/io/input_file.h"
#include "interfaces/selection/saved_hierarchy_file.h"

namespace adamas {

bool is_saved_hierarchy(const std::string& path) {
  return file_extension(path) == ".h5" && is_array_file(path, kHierarchyFormat);
}

SavedHierarchy load_saved_hierarchy(const std::string& path, Console& console) {
  check_input_file(path);
  console.step("reading " + path, -1);
  return from_arrays(read_array_file(path, kHierarchyFormat, kHierarchyVersion).arrays, path);
}

}  // namespace adamas
