#include "interfaces/input/grid_source.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/loop_progress.h"
#include "core/base/parallel.h"
#include "interfaces/fields/grid_field_source.h"
#include "interfaces/network/grid_bodies.h"
#include "interfaces/network/network_measures.h"
#include "interfaces/reconstruction/grid_sites.h"

namespace adamas::interfaces {

namespace {

std::vector<MaterialId> materials_of(const std::vector<BodyId>& bodies, const InterfaceTable& table) {
  std::vector<MaterialId> materials(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) materials[i] = table.material(bodies[i]);
  return materials;
}

/// Returns the volumes of the network's bodies; those of each material add up to the volume that the
/// interfaces are to enclose.
IdVector<BodyId, double> body_volumes(const InterfaceNetwork& network, const Box3& box,
                                      const IdVector<MaterialId, double>& stated) {
  NetworkMeasures measures = measure_network(network, box, stated.size());
  for (BodyId b(0); b.value < measures.body_volumes.size(); ++b.value) {
    const MaterialId m = network.table().material(b);
    if (measures.volumes[m] > 0) measures.body_volumes[b] *= stated[m] / measures.volumes[m];
  }
  return std::move(measures.body_volumes);
}

}  // namespace

ResamplingSource make_grid_source(const MultiMaterialData& data, const ReconstructionOptions& options,
                                  Progress& progress) {
  auto reconstruction = std::make_shared<Reconstruction>(data, options, progress);
  reconstruction->keep_bodies_alone();
  const LoopProgress stage(progress, "finding bodies");
  ResamplingSource source;
  source.name = data.source;
  source.box = data.grid.domain();
  source.materials = data.materials;
  source.volumes = reconstruction->volume_input();
  if (data.labels.empty()) source.findings = reconstruction->findings();
  source.voxel = data.grid.least_spacing();
  source.network = std::make_shared<InterfaceNetwork>(
      reconstruction->take_mesh(), source.box,
      Bodies{reconstruction->take_bodies(), reconstruction->body_materials()});
  if (!source.network->triangles().empty())
    source.body_volumes = body_volumes(*source.network, source.box, reconstruction->volume_wanted());
  source.body_at = [reconstruction](const Vec3& p, bool* flagged) {
    if (flagged != nullptr) *flagged = false;
    return reconstruction->body_at(p);
  };
  if (!data.fields.empty()) {
    std::vector<BodyId> bodies(data.grid.site_count());
    const GridSites sites(data.grid);
    parallel_for(bodies.size(), 1024,
                 [&](std::size_t i) { bodies[i] = reconstruction->body_at(sites.position(i)); });
    source.fields = std::make_shared<GridFieldSource>(data, materials_of(bodies, source.network->table()));
  }
  return source;
}

ResamplingSource make_mesh_source(const InterfaceMesh& mesh, const Box3& box, const MultiMaterialData* data,
                                  Progress& progress) {
  progress.step("finding bodies", -1);
  ResamplingSource source;
  source.name = mesh.source;
  source.box = box;
  source.materials = mesh.materials;
  const bool fields = data != nullptr && !data->fields.empty();
  InterfaceMesh renamed = mesh;
  if (fields) {
    // Materials have the data's numbers.
    source.materials = renamed.materials = data->materials;
    const auto in_data = [&](MaterialId m) {
      const auto found = std::find(data->materials.begin(), data->materials.end(), mesh.materials[m]);
      if (found != data->materials.end())
        return MaterialId(static_cast<std::size_t>(found - data->materials.begin()));
      fail("{}: expected the materials of {}, found '{}'", mesh.source, data->source, mesh.materials[m]);
    };
    for (InterfaceTriangle& t : renamed.triangles) {
      t.front = in_data(t.front);
      t.back = in_data(t.back);
    }
  }
  auto network = std::make_shared<InterfaceNetwork>(renamed, box);
  if (network->table().body_count() == 0)
    fail("{}: expected triangles between two materials, found none", mesh.source);
  source.network = network;
  if (data != nullptr) source.voxel = data->grid.least_spacing();
  // Volumes are unknown if interfaces have open borders or do not match.
  if (!network->has_open_border() && network->inconsistencies() == 0) {
    NetworkMeasures measures = measure_network(*network, box, source.materials.size());
    source.volumes = std::move(measures.volumes);
    source.body_volumes = std::move(measures.body_volumes);
  }
  source.body_at = [network](const Vec3& p, bool* flagged) { return network->body_at(p, flagged); };
  if (fields) {
    progress.step("finding owners of sites", -1);
    source.fields = std::make_shared<GridFieldSource>(
        *data, materials_of(bodies_at_sites(*network, data->grid), network->table()));
  }
  return source;
}

}  // namespace adamas::interfaces
