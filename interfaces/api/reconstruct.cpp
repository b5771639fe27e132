#include "adamas/reconstruct.h"

#include <algorithm>
#include <utility>

#include "core/base/loop_progress.h"
#include "interfaces/api/input.h"
#include "interfaces/api/interface_areas.h"
#include "interfaces/api/simplify.h"
#include "interfaces/input/mesh_source.h"
#include "interfaces/network/interface_network.h"
#include "interfaces/network/network_measures.h"
#include "interfaces/reconstruction/dispersed_volume.h"
#include "interfaces/reconstruction/reconstruction.h"

namespace adamas {

using namespace interfaces;

namespace {

bool is_one_step_at_most(MaterialId material, const MultiMaterialData& data) {
  if (data.fractions.empty() || data.report.step == 0) return false;
  const SiteArray<float>& fractions = data.fractions[material];
  return std::all_of(fractions.begin(), fractions.end(),
                     [&](float fraction) { return is_one_step(static_cast<double>(fraction), data.report); });
}

/// Adds bodies and materials that the volume fractions contain but the interfaces do not show.
void add_losses(const MultiMaterialData& data, const Reconstruction& found, ReconstructedInterfaces& result) {
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value) {
    const double volume = found.volume_input()[m];
    if (volume <= 0 || found.volume_reconstructed()[m] > 0 || is_all_dispersed(found.findings(), m, volume))
      continue;
    result.lost_materials.push_back({m.value, volume, is_one_step_at_most(m, data)});
  }
  for (const LostBody& body : found.lost_bodies())
    result.lost_places.push_back({body.material.value, body.volume, body.cells, body.fraction, body.place,
                                  is_one_step(body.fraction, data.report)});
}

/// Moves a mesh with its bodies into the result.
void take_mesh(InterfaceMesh&& mesh, const std::vector<std::array<BodyId, 2>>& bodies,
               ReconstructedInterfaces& result) {
  result.interfaces = interface_areas(mesh);
  result.mesh = to_interface_triangles(std::move(mesh), bodies);
}

ReconstructedInterfaces reconstruct_grid(const MultiMaterialData& data, const ReconstructOptions& options,
                                         Progress& progress) {
  const ReconstructionOptions how{.smooth_labels = options.smooth_labels, .fractions = options.fractions};
  check_reconstruction(how, data);
  Reconstruction found(data, how, progress);
  ReconstructedInterfaces result;
  result.input = data.source;
  result.domain = data.grid.domain();
  for (MaterialId m(0); m.value < data.materials.size(); ++m.value)
    result.materials.push_back({data.materials[m], found.volume_input()[m], found.volume_reconstructed()[m]});
  result.bodies = found.body_materials().size();
  if (data.labels.empty()) result.fractions = found.findings();
  result.agreement = found.agreement();
  add_losses(data, found, result);
  if (options.simplify.error) {
    ResamplingSource source =
        source_of_interfaces(found.mesh(), result.domain, found.take_bodies(), found.body_materials());
    source.voxel = data.grid.least_spacing();
    SimplifiedNetwork simplified =
        simplify_source(source, options.simplify, result.simplification.emplace(), progress);
    take_mesh(std::move(simplified.mesh), simplified.bodies, result);
  } else {
    take_mesh(found.take_mesh(), found.bodies(), result);
  }
  return result;
}

ReconstructedInterfaces take_given(const ResamplingSource& source, const ReconstructOptions& options,
                                   Progress& progress) {
  ReconstructedInterfaces result;
  result.input = source.name;
  result.domain = source.box;
  for (MaterialId m(0); m.value < source.materials.size(); ++m.value)
    result.materials.push_back({source.materials[m], std::nullopt,
                                source.volumes.empty() ? std::nullopt : std::optional(source.volumes[m])});
  result.bodies = source.network->table().body_count();
  if (options.simplify.error) {
    SimplifiedNetwork simplified =
        simplify_source(source, options.simplify, result.simplification.emplace(), progress);
    take_mesh(std::move(simplified.mesh), simplified.bodies, result);
  } else {
    result.interfaces = interface_areas(source);
    result.mesh = to_interface_triangles(network_mesh(*source.network, source.materials, source.name),
                                         triangle_bodies(*source.network));
  }
  return result;
}

ReconstructedInterfaces reconstruct_cells(const MeshData& data, const ReconstructOptions& options,
                                          Progress& progress) {
  check_reconstruction({.smooth_labels = options.smooth_labels, .fractions = options.fractions}, data);
  MeshReconstruction found = reconstruct_mesh(data, options.fractions, progress);
  const MeshAgreement agreement = found.agreement;
  const ResamplingSource source = make_cells_source(data, std::move(found), progress);
  ReconstructedInterfaces result = take_given(source, options, progress);
  // Without interfaces one material fills the box.
  IdVector<MaterialId, double> found_volumes = source.volumes;
  if (!source.network->triangles().empty())
    found_volumes = measure_network(*source.network, source.box, source.materials.size()).volumes;
  for (MaterialId m(0); m.value < source.materials.size(); ++m.value) {
    result.materials[m.value].volume_input = source.volumes[m];
    result.materials[m.value].volume_reconstructed = found_volumes[m];
    const bool dispersed = source.findings && is_all_dispersed(*source.findings, m, source.volumes[m]);
    if (source.volumes[m] > 0 && !(found_volumes[m] > 0) && !dispersed)
      result.lost_materials.push_back({m.value, source.volumes[m], false});
  }
  result.fractions = source.findings;
  result.agreement = agreement.cells;
  result.lost_places = agreement.lost;
  return result;
}

}  // namespace

ReconstructedInterfaces reconstruct(Input input, const ReconstructOptions& options, Progress& progress) {
  const LoopProgress loops(progress);
  check(options.simplify, input);
  const std::shared_ptr<Input::Contents> contents = std::move(input).release();
  if (contents->cells) return reconstruct_cells(*contents->cells, options, progress);
  if (!contents->mesh) return reconstruct_grid(*contents->data, options, progress);
  const ReconstructionOptions how{.smooth_labels = options.smooth_labels, .fractions = options.fractions};
  return take_given(
      contents.use_count() == 1 ? contents->take_source(how, progress) : contents->source(how, progress),
      options, progress);
}

ReconstructedInterfaces reconstruct(const GridData& data, const ReconstructOptions& options,
                                    Progress& progress) {
  return reconstruct(Input(data), options, progress);
}

}  // namespace adamas
