#include "workflow/input/resampled_mesh.h"

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

SavedHierarchy load_saved_hierarchy(const std::filesystem::path& path, Progress& progress) {
  check_input_file(path);
  progress.step("reading " + path.string(), -1);
  const ArrayFile file =
      read_array_file(path, kHierarchyFormat, names_of_arrays(), kOldestHierarchyVersion, kHierarchyVersion);
  return from_arrays(file.arrays, path.string(), file.version);
}

ResampledMesh load_resampled_mesh(const std::filesystem::path& path, Progress& progress) {
  if (is_saved_hierarchy(path)) return whole_mesh(load_saved_hierarchy(path, progress));
  check_input_file(path);
  progress.step("reading " + path.string(), -1);
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (!is_resampled_mesh(mesh))
    fail("{}: expected a mesh written by adamas resample, found another one", path.string());
  return from_unstructured_mesh(mesh, path.string());
}

}  // namespace adamas::workflow
