#include "interfaces/input/mesh_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/loop_progress.h"
#include "interfaces/fields/mesh_field_source.h"
#include "interfaces/mesh_reconstruction/mesh_reconstruction.h"
#include "interfaces/network/network_measures.h"

namespace adamas::interfaces {

ResamplingSource make_cells_source(const MeshData& data, Progress& progress) {
  return make_cells_source(data, reconstruct_mesh(data, progress), progress);
}

ResamplingSource make_cells_source(const MeshData& data, MeshReconstruction&& reconstruction,
                                   Progress& progress) {
  const LoopProgress stage(progress, "finding bodies");
  ResamplingSource source;
  source.name = data.source;
  source.box = data.mesh.box();
  source.materials = reconstruction.mesh.materials;
  source.volumes = data.volumes();
  double inside = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) {
    inside += data.mesh.cell_volume(c);
    if (data.mesh.cell_volume(c) > 0) least = std::min(least, data.mesh.cell_volume(c));
  }
  if (source.materials.size() > source.volumes.size()) source.volumes.push_back(source.box.volume() - inside);
  source.voxel = std::cbrt(least);
  if (data.labels.empty()) source.findings = std::move(reconstruction.agreement.findings);
  const auto network = std::make_shared<InterfaceNetwork>(reconstruction.mesh, source.box);
  source.network = network;
  if (!network->triangles().empty()) {
    NetworkMeasures measures = measure_network(*network, source.box, source.materials.size());
    for (BodyId b(0); b.value < measures.body_volumes.size(); ++b.value) {
      const MaterialId m = network->table().material(b);
      if (measures.volumes[m] > 0) measures.body_volumes[b] *= source.volumes[m] / measures.volumes[m];
    }
    source.body_volumes = std::move(measures.body_volumes);
    for (InterfaceId i(0); source.findings && i.value < measures.areas.size(); ++i.value) {
      const auto [a, b] = network->table().sides(i);
      // The boundary of the mesh is no interface of the fractions.
      if (std::max(network->table().material(a).value, network->table().material(b).value) <
          data.materials.size())
        source.findings->area += measures.areas[i];
    }
    if (source.findings) source.findings->area_of_fractions = source.findings->area;
  }
  source.body_at = [network](const Vec3& p, bool* flagged) { return network->body_at(p, flagged); };
  if (!data.fields.empty()) {
    const auto material_at = [&](const Vec3& p) { return network->table().material(network->body_at(p)); };
    source.fields = std::make_shared<MeshFieldSource>(data, material_at);
  }
  return source;
}

}  // namespace adamas::interfaces
