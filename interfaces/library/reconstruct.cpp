#include "adamas/reconstruct.h"

#include <cmath>

#include "core/base/error.h"
#include "core/data/grid_data.h"
#include "interfaces/library/adaptive_mesh.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/simplification/interface_simplification.h"

namespace adamas {

using namespace interfaces;

ReconstructedInterfaces reconstruct(const GridData& given, const ReconstructOptions& options,
                                    Progress& progress) {
  const MultiMaterialData data = to_multi_material_data(given);
  if (!(options.simplify >= 0) || !std::isfinite(options.simplify))
    fail("{}: expected an error of simplification of at least 0, found {}", data.source, options.simplify);
  Reconstruction found(data, {.smooth_labels = options.smooth_labels, .fractions = options.fractions},
                       progress);
  ReconstructedInterfaces result;
  result.bodies = found.body_materials().size();
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
    result.materials.push_back({data.materials[m], found.volume_input()[m], found.volume_reconstructed()[m]});
  if (data.labels.empty()) result.fractions = found.findings();
  InterfaceMesh mesh = found.take_mesh();
  if (options.simplify > 0) {
    const ResamplingSource source =
        source_of_interfaces(mesh, data.grid.domain(), found.take_bodies(), found.body_materials());
    SimplificationOptions how;
    how.error = options.simplify;
    mesh = simplify_interfaces(source, how, progress).mesh;
  }
  mesh.materials = data.materials;
  result.mesh = to_interface_triangles(std::move(mesh));
  return result;
}

}  // namespace adamas
