#pragma once

#include <functional>
#include <optional>
#include <string>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "cli/input_options.h"
#include "core/data/interface_mesh.h"
#include "core/geometry/plane.h"
#include "core/io/multi_material_reader.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::cli {

/// Which step of a series something is of.
struct StepOfSeries {
  double time = 0;
  std::size_t number = 0;
};

/// What a slice is cut from: the input's own data and interfaces, a resampled mesh, both, or interfaces
/// alone.
struct SliceInput {
  std::string name;
  std::unique_ptr<MultiMaterialData> data;
  std::optional<InterfaceMesh> interfaces;  ///< the original ones
  std::optional<interfaces::ResampledMesh> mesh;
  std::optional<interfaces::ResamplingSource> network;  ///< given interfaces without data
  /// Of samples whose axes are not x, y and z: the data are in its frame.
  std::optional<VolumeGrid> turned;
  std::optional<StepOfSeries> step{};
  std::string sample_name{};  ///< of samples: the name of their array; empty where that is not known

  /// Whether the data have no materials.
  [[nodiscard]] bool plain() const { return data && !mesh && io::is_plain(*data); }
  /// What the plane cuts out of the domain, in space.
  [[nodiscard]] std::vector<Vec3> outline(const Plane& plane) const;
  /// Of the domain; of samples in their frame.
  [[nodiscard]] Box3 box() const {
    if (mesh) return mesh->box;
    return network ? network->box : data->grid.domain();
  }
  [[nodiscard]] const IdVector<MaterialId, std::string>& materials() const {
    if (mesh) return mesh->materials;
    return network ? network->materials : data->materials;
  }
};

/// Reads a resampled mesh from .vtu, or the whole one from a saved hierarchy. Throws Error for another mesh.
interfaces::ResampledMesh load_resampled_mesh(const std::string& path, Console& console);

/// Reads the positional input, a resampled mesh, gridded data or given interfaces, and for a mesh the
/// original data or interfaces, where given; the original data get the mesh's order of materials. `check`
/// looks at what was read before long work and may throw. Interfaces of gridded data are reconstructed where
/// they are wanted. Throws Error where the original has another box or other materials than the mesh.
SliceInput load_slice_input(const InputArguments& options, const std::string& original, bool with_interfaces,
                            const std::function<void(const SliceInput&)>& check, Console& console);

}  // namespace adamas::cli
