#include "interfaces/input/mesh_source.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "interfaces/fields/mesh_field_source.h"
#include "interfaces/mesh_reconstruction/mesh_interfaces.h"
#include "interfaces/network/network_measures.h"

namespace adamas::interfaces {

namespace {

/// Adds the volume of what the mesh does not fill of the box round it to that of the outside.
void add_outside(const MeshData& data, ResamplingSource& source) {
  double rest = source.box.volume();
  for (std::size_t c = 0; c < data.mesh.cell_count(); ++c) rest -= data.mesh.cell_volume(c);
  if (rest < 0)
    fail("{}: expected cells apart from each other, found them to fill {:.6g} more than the box round them",
         data.source, -rest);
  const auto outside = std::ranges::find(source.materials, kOutside) - source.materials.begin();
  if (source.volumes.size() < source.materials.size()) source.volumes.push_back(0);
  source.volumes[MaterialId(static_cast<std::size_t>(outside))] += rest;
}

/// Makes the network of interfaces; if there are none, of the one material that fills the box.
std::shared_ptr<const InterfaceNetwork> make_network(InterfaceMesh&& mesh, Bodies&& bodies,
                                                     const ResamplingSource& source) {
  if (mesh.triangles.empty()) {
    const auto most = std::ranges::max_element(source.volumes) - source.volumes.begin();
    bodies.materials.assign(1, MaterialId(static_cast<std::size_t>(most)));
  }
  return std::make_shared<InterfaceNetwork>(std::move(mesh), source.box, std::move(bodies));
}

}  // namespace

ResamplingSource make_cells_source(const MeshData& data, const FractionOptions& options, Progress& progress) {
  return make_cells_source(data, reconstruct_mesh(data, options, progress), progress);
}

ResamplingSource make_cells_source(const MeshData& data, MeshReconstruction&& reconstruction,
                                   Progress& progress) {
  const LoopProgress stage(progress, "finding bodies");
  ResamplingSource source;
  source.name = data.source;
  source.box = data.mesh.box();
  source.materials = reconstruction.mesh.materials;
  const IdVector<MaterialId, double> stated = data.volumes();
  source.volumes = stated;
  if (!data.mesh.fills_box()) add_outside(data, source);
  source.voxel = data.mesh.typical_size();
  if (data.labels.empty()) source.findings = std::move(reconstruction.agreement.findings);
  const std::shared_ptr<const InterfaceNetwork> network =
      make_network(std::move(reconstruction.mesh), std::move(reconstruction.bodies), source);
  source.network = network;
  if (!network->triangles().empty()) {
    // What is dispersed is in other materials' bodies.
    IdVector<MaterialId, double> wanted = source.volumes;
    for (MaterialId m(0); m.value < stated.size(); ++m.value)
      wanted[m] += reconstruction.agreement.volumes[m] - stated[m];
    NetworkMeasures measures = measure_network(*network, source.box, source.materials.size());
    for (BodyId b(0); b.value < measures.body_volumes.size(); ++b.value) {
      const MaterialId m = network->table().material(b);
      if (measures.volumes[m] > 0) measures.body_volumes[b] *= wanted[m] / measures.volumes[m];
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
