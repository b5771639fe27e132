#include "interfaces/mesh_reconstruction/mesh_reconstruction.h"

#include "interfaces/mesh_reconstruction/mesh_correction.h"
#include "interfaces/mesh_reconstruction/mesh_interfaces.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

MeshReconstruction reconstruct_mesh(const MeshData& data, const FractionOptions& options,
                                    Progress& progress) {
  if (!data.labels.empty()) {
    MeshReconstruction result{interfaces_of_labels(data), {}, {}};
    result.bodies = find_bodies(result.mesh, &data.mesh.box());
    result.agreement.volumes = data.volumes();
    return result;
  }
  progress.step("finding materials near cells", -1);
  const MeshSubdivision subdivision(data.mesh);
  MeshValues values(data, subdivision);
  return reconstruct_fractions(data, options, values, progress);
}

}  // namespace adamas::interfaces
