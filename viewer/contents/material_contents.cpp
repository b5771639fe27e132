#include "viewer/contents/material_contents.h"

#include <cstdint>

#include "core/base/error.h"
#include "core/io/array_file.h"
#include "core/io/input_file.h"
#include "core/io/input_formats.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/selection/saved_hierarchy_file.h"
#include "interfaces/selection/selection.h"

namespace adamas::viewer {

using namespace interfaces;
using namespace io;

namespace {

enum class MaterialFile : std::uint8_t { kHierarchy, kMesh, kInterfaces, kOther };

MaterialFile material_file(const std::string& path) {
  if (file_extension(path) == ".h5" && is_array_file(path, kHierarchyFormat)) return MaterialFile::kHierarchy;
  switch (kind_by_format(path)) {
    case InputKind::kMesh:
    case InputKind::kCells:
      return MaterialFile::kMesh;
    case InputKind::kPolygons:
    case InputKind::kNetwork:
      return MaterialFile::kInterfaces;
    default:
      return MaterialFile::kOther;
  }
}

ResampledMesh read_resampled_mesh(const std::string& path) {
  if (kind_by_format(path) == InputKind::kCells) {
    fail("{}: expected a mesh written by adamas resample, found another, of which adamas resample makes one",
         path);
  }
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (!is_resampled_mesh(mesh)) fail("{}: expected a mesh written by adamas resample, found another", path);
  return from_unstructured_mesh(mesh, path);
}

ResampledMesh read_whole_mesh(const std::string& path) {
  const ArrayFile file = read_array_file(path, kHierarchyFormat, names_of_tree_arrays(),
                                         kOldestHierarchyVersion, kHierarchyVersion);
  return whole_mesh(tree_from_arrays(file.arrays, path));
}

}  // namespace

bool MaterialContents::can_open(const std::string& path) {
  return material_file(path) != MaterialFile::kOther;
}

std::unique_ptr<MaterialContents> MaterialContents::open(const std::string& path, Progress& progress) {
  check_input_file(path);
  const MaterialFile kind = material_file(path);
  if (kind == MaterialFile::kOther) {
    fail(
        "{}: expected a resampled mesh (.vtu), a saved hierarchy (.h5) or interfaces between materials "
        "(.vtp, "
        ".ply, .arec, .txt), found another file",
        path);
  }
  progress.step("reading " + path, -1);
  if (kind == MaterialFile::kInterfaces) return make_network_contents(read_interface_mesh(path), progress);
  return make_resampled_contents(
      kind == MaterialFile::kMesh ? read_resampled_mesh(path) : read_whole_mesh(path), progress);
}

}  // namespace adamas::viewer
