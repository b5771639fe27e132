#include "workflow/input/resampled_mesh.h"

#include "adamas/read_mesh.h"
#include "core/base/error.h"
#include "core/io/input_file.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/library/adaptive_mesh.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/selection/selection.h"
#include "workflow/input/saved_hierarchy.h"

namespace adamas {

using namespace interfaces;
using namespace io;

namespace workflow {

ResampledMesh load_resampled_mesh(const std::filesystem::path& path, Progress& progress) {
  if (is_saved_hierarchy(path)) return whole_mesh(load_saved_hierarchy(path, progress));
  check_input_file(path);
  progress.step("reading " + path.string(), -1);
  const UnstructuredMesh mesh = read_unstructured_mesh(path);
  if (!is_resampled_mesh(mesh))
    fail("{}: expected a mesh written by adamas resample, found another one", path.string());
  return from_unstructured_mesh(mesh, path.string());
}

}  // namespace workflow

AdaptiveMesh read_adaptive_mesh(const std::filesystem::path& path, Progress& progress) {
  auto contents = std::make_unique<AdaptiveMesh::Contents>();
  ResampledMesh& mesh = contents->mesh;
  mesh = workflow::load_resampled_mesh(path, progress);
  contents->report.input = mesh.source;
  contents->report.tetrahedra = mesh.cells.size();
  contents->report.vertices = mesh.points.size();
  for (const auto& cell : mesh.cells) contents->tetrahedra.push_back(cell.vertices);
  return AdaptiveMesh(std::move(contents));
}

}  // namespace adamas
