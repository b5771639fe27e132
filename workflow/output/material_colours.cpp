#include "adamas/material_colours.h"

#include <utility>
#include <vector>

#include "core/data/interface_mesh.h"
#include "core/io/array_file.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/named_colours.h"
#include "core/io/solver_mesh_io.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/api/cut_mesh.h"
#include "interfaces/api/select.h"
#include "interfaces/mesh/resampled_mesh_file.h"
#include "interfaces/selection/saved_hierarchy_file.h"
#include "workflow/output/resampled_mesh_output.h"

namespace adamas {

using namespace interfaces;
using namespace io;

MaterialColours find_material_colours(const InputOptions& options) {
  return find_named_colours(with_main_file(options).path, options.region_names);
}

void workflow::write_resampled_mesh(const std::filesystem::path& path, const ResampledMesh& mesh,
                                    const MaterialColours& colours) {
  UnstructuredMesh file = to_unstructured_mesh(mesh);
  add_colours(mesh.materials, colours, file.field_arrays);
  write_unstructured_mesh(path, std::move(file));
}

void write_mesh(const std::filesystem::path& path, const AdaptiveMesh& mesh, const MaterialColours& colours) {
  workflow::write_resampled_mesh(path, mesh.contents().mesh(), colours);
}

void write_mesh(const std::filesystem::path& path, const InterfaceTriangles& mesh,
                const MaterialColours& colours) {
  write_interface_mesh(path, to_interface_mesh(mesh, path.string()), colours);
}

void write_mesh(const std::filesystem::path& path, const CutMesh& mesh, const MaterialColours& colours) {
  write_solver_mesh(path, mesh.contents().mesh, colours);
}

void write_hierarchy(const std::filesystem::path& path, const MultiresolutionMesh& mesh,
                     const MaterialColours& colours) {
  const SavedHierarchy& hierarchy = mesh.contents().hierarchy;
  std::vector<NamedArray> arrays = to_arrays(hierarchy);
  add_colours(hierarchy.tree.materials, colours, arrays);
  write_array_file(path, {kHierarchyFormat, kHierarchyVersion, std::move(arrays)});
}

}  // namespace adamas
