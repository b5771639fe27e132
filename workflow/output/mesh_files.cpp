#include "adamas/mesh_files.h"

#include "core/base/loop_progress.h"
#include "core/io/array_file.h"
#include "core/io/solver_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/api/cut_mesh.h"
#include "interfaces/api/select.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/selection/saved_hierarchy_file.h"
#include "workflow/input/load_mesh.h"

namespace adamas {

using namespace interfaces;
using namespace io;

void write_mesh(const std::filesystem::path& path, const AdaptiveMesh& mesh) {
  write_unstructured_mesh(path, to_unstructured_mesh(mesh.contents().mesh()));
}

AdaptiveMesh read_adaptive_mesh(const std::filesystem::path& path, Progress& progress) {
  return AdaptiveMesh(
      std::make_unique<AdaptiveMesh::Contents>(workflow::load_resampled_mesh(path, progress)));
}

void write_mesh(const std::filesystem::path& path, const CutMesh& mesh) {
  write_solver_mesh(path, mesh.contents().mesh);
}

void write_faces(const std::filesystem::path& path, const CutMesh& mesh) {
  write_unstructured_mesh(path, face_surface(mesh.contents().mesh));
}

void write_hierarchy(const std::filesystem::path& path, const MultiresolutionMesh& mesh) {
  write_array_file(path, {kHierarchyFormat, kHierarchyVersion, to_arrays(mesh.contents().hierarchy)});
}

MultiresolutionMesh read_hierarchy(const std::filesystem::path& path, Progress& progress) {
  const LoopProgress loops(progress);
  auto contents = std::make_unique<MultiresolutionMesh::Contents>();
  contents->name = path.string();
  contents->hierarchy = workflow::load_saved_hierarchy(path, progress);
  return MultiresolutionMesh(std::move(contents));
}

}  // namespace adamas
