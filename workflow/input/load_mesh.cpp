#include "workflow/input/load_mesh.h"

#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/io/array_file.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/selection/saved_hierarchy_file.h"
#include "interfaces/selection/selection.h"

namespace adamas::workflow {

using namespace interfaces;
using namespace io;

bool is_saved_hierarchy(const std::filesystem::path& path) {
  return file_extension(path) == ".h5" && is_array_file(path, kHierarchyFormat);
}

namespace {

ArrayFile read_arrays(const std::filesystem::path& path, const std::vector<std::string>& names,
                      Progress& progress) {
  check_input_file(path);
  progress.step("reading " + path.string(), -1);
  return read_array_file(path, kHierarchyFormat, names, kOldestHierarchyVersion, kHierarchyVersion);
}

}  // namespace

SavedHierarchy load_saved_hierarchy(const std::filesystem::path& path, Progress& progress) {
  const ArrayFile file = read_arrays(path, names_of_arrays(), progress);
  return from_arrays(file.arrays, path.string(), file.version);
}

SavedHierarchy load_saved_tree(const std::filesystem::path& path, Progress& progress) {
  return tree_from_arrays(read_arrays(path, names_of_tree_arrays(), progress).arrays, path.string());
}

ResampledMesh load_resampled_mesh(const std::filesystem::path& path, Progress& progress) {
  if (is_saved_hierarchy(path)) return whole_mesh(load_saved_tree(path, progress));
  check_input_file(path);
  progress.step("reading " + path.string(), -1);
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (!is_resampled_mesh(mesh))
    fail("{}: expected a mesh written by adamas resample, found another one", path.string());
  return from_unstructured_mesh(mesh, path.string());
}

}  // namespace adamas::workflow
