#include "interfaces/grid_source.h"

#include <algorithm>

#include "interfaces/fields/grid_field_source.h"

namespace adamas {

ResamplingSource make_grid_source(const MultiMaterialData& data, Progress& progress) {
  auto reconstruction = std::make_shared<Reconstruction>(data, progress);
  ResamplingSource source;
  source.name = data.source;
  source.box = data.grid.domain();
  source.materials = data.materials;
  source.volumes = reconstruction->volume_input();
  {
    const InterfaceMesh mesh = reconstruction->take_mesh();
    source.network = std::make_shared<InterfaceNetwork>(
        mesh, source.box, Bodies{reconstruction->take_bodies(), reconstruction->body_materials()});
  }
  source.body_at = [reconstruction](const Vec3& p, bool* flagged) {
    if (flagged != nullptr) *flagged = false;
    return reconstruction->body_at(p);
  };
  if (!data.fields.empty()) {
    source.fields = std::make_shared<GridFieldSource>(
        data, [&](const Vec3& p) { return source.network->table().material(reconstruction->body_at(p)); });
  }
  return source;
}

ResamplingSource make_mesh_source(const InterfaceMesh& mesh, const Box3& box, const MultiMaterialData* data) {
  ResamplingSource source;
  source.name = mesh.source;
  source.box = box;
  source.materials = mesh.materials;
  const bool fields = data != nullptr && !data->fields.empty();
  InterfaceMesh renamed = mesh;
  if (fields) {
    // The data's numbers for the materials of both.
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
  source.body_at = [network](const Vec3& p, bool* flagged) { return network->body_at(p, flagged); };
  if (fields) {
    source.fields = std::make_shared<GridFieldSource>(
        *data, [&](const Vec3& p) { return network->table().material(network->body_at(p)); });
  }
  return source;
}

}  // namespace adamas
