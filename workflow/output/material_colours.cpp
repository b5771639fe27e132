#include "adamas/material_colours.h"

#include "core/data/interface_mesh.h"
#include "core/io/interface_mesh_io.h"
#include "core/io/named_colours.h"
#include "core/io/unstructured_mesh_io.h"
#include "interfaces/api/adaptive_mesh.h"
#include "interfaces/mesh/resampled_mesh_file.h"

namespace adamas {

using namespace interfaces;
using namespace io;

MaterialColours find_material_colours(const InputOptions& options) {
  return find_named_colours(with_main_file(options).path, options.region_names);
}

void write_mesh(const std::filesystem::path& path, const AdaptiveMesh& mesh, const MaterialColours& colours) {
  const ResampledMesh& resampled = mesh.contents().mesh();
  UnstructuredMesh file = to_unstructured_mesh(resampled);
  add_colours(resampled.materials, colours, file.field_arrays);
  write_unstructured_mesh(path, std::move(file));
}

void write_mesh(const std::filesystem::path& path, const InterfaceTriangles& mesh,
                const MaterialColours& colours) {
  write_interface_mesh(path, to_interface_mesh(mesh, path.string()), colours);
}

}  // namespace adamas
