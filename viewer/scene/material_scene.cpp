#include "viewer/scene/material_scene.h"

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
#include "viewer/scene/network_scene.h"
#include "viewer/scene/resampled_scene.h"

namespace adamas::viewer {

using namespace interfaces;
using namespace io;

namespace {

enum class SceneFile : std::uint8_t { kHierarchy, kMesh, kInterfaces, kOther };

SceneFile scene_file(const std::string& path) {
  if (file_extension(path) == ".h5" && is_array_file(path, kHierarchyFormat)) return SceneFile::kHierarchy;
  switch (input_kind(path)) {
    case InputKind::kMesh:
      return SceneFile::kMesh;
    case InputKind::kPolygons:
    case InputKind::kNetwork:
      return SceneFile::kInterfaces;
    default:
      return SceneFile::kOther;
  }
}

ResampledMesh read_resampled_mesh(const std::string& path) {
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (!is_resampled_mesh(mesh)) fail("{}: expected a mesh written by adamas resample, found another", path);
  return from_unstructured_mesh(mesh, path);
}

ResampledMesh read_whole_mesh(const std::string& path) {
  const ArrayFile file =
      read_array_file(path, kHierarchyFormat, names_of_arrays(), kOldestHierarchyVersion, kHierarchyVersion);
  return whole_mesh(from_arrays(file.arrays, path, file.version));
}

}  // namespace

bool MaterialScene::can_open(const std::string& path) { return scene_file(path) != SceneFile::kOther; }

std::unique_ptr<MaterialScene> MaterialScene::open(const std::string& path, Progress& progress) {
  check_input_file(path);
  const SceneFile kind = scene_file(path);
  if (kind == SceneFile::kOther) {
    fail(
        "{}: expected a resampled mesh (.vtu), a saved hierarchy (.h5) or interfaces between materials "
        "(.vtp, "
        ".ply, .arec, .txt), found another file",
        path);
  }
  progress.step("reading " + path, -1);
  if (kind == SceneFile::kInterfaces) return make_network_scene(read_interface_mesh(path), progress);
  return make_resampled_scene(kind == SceneFile::kMesh ? read_resampled_mesh(path) : read_whole_mesh(path),
                              progress);
}

}  // namespace adamas::viewer
