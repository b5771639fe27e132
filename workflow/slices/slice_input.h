#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/data/interface_mesh.h"
#include "core/data/mesh_data.h"
#include "core/data/multi_material_data.h"
#include "core/geometry/plane.h"
#include "core/io/multi_material_reader.h"
#include "core/io/named_colours.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::workflow {

/// Identifies a step of a series.
struct StepOfSeries {
  double time = 0;
  std::size_t number = 0;
};

/// The data that a slice is cut from: the input's own data and interfaces, a resampled mesh, both, or
/// interfaces alone.
struct SliceInput {
  std::string name;
  std::unique_ptr<MultiMaterialData> data;
  std::optional<InterfaceMesh> interfaces;  ///< the interfaces of the input
  std::optional<interfaces::ResampledMesh> mesh;
  /// Given interfaces without data, or those of data on a mesh of cells.
  std::optional<interfaces::ResamplingSource> network;
  std::unique_ptr<MeshData> cells;  ///< what `network` was made of; null unless it was data on a mesh
  /// The grid of samples whose axes are not x, y and z: the data are in its frame.
  std::optional<VolumeGrid> turned;
  std::optional<StepOfSeries> step{};
  io::NamedColours colours{};  ///< of materials for which the files have one
  std::string sample_name{};   ///< for samples: the name of their array; empty where that is not known

  /// Returns whether the data have no materials.
  [[nodiscard]] bool plain() const { return data && !mesh && io::is_plain(*data); }
  /// Returns the polygon in which the plane cuts the domain, in space.
  [[nodiscard]] std::vector<Vec3> outline(const Plane& plane) const;
  /// Returns the box of the domain; for samples in their frame.
  [[nodiscard]] Box3 box() const {
    if (mesh) return mesh->box;
    return network ? network->box : data->grid.domain();
  }
  [[nodiscard]] const IdVector<MaterialId, std::string>& materials() const {
    if (mesh) return mesh->materials;
    return network ? network->materials : data->materials;
  }
};

}  // namespace adamas::workflow
