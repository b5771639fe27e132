#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "adamas/read_input.h"
#include "adamas/resample.h"
#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"
#include "core/data/mesh_data.h"
#include "core/data/multi_material_data.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/reconstruction/reconstruction.h"

namespace adamas::workflow {

/// Reads data on a grid; notes what was mended in its volume fractions beyond round-off.
MultiMaterialData load_data(const InputOptions& options, Progress& progress);

/// Reads data on a mesh; notes what was mended in its volume fractions beyond round-off.
MeshData load_mesh_data(const InputOptions& options, Progress& progress);

/// Reads given interfaces as they are.
InterfaceMesh read_given_interfaces(const InputOptions& options);

/// Reads an input of any kind.
std::shared_ptr<Input::Contents> load_contents(const InputOptions& options, Progress& progress);

/// An input that is ready to be resampled or cut.
struct LoadedInput {
  std::unique_ptr<MultiMaterialData> data;  ///< null for interface meshes alone, and for data on a mesh
  std::unique_ptr<MeshData> cells;          ///< null unless it is data on a mesh
  interfaces::ResamplingSource source;      ///< refers to `data` or `cells`
};

/// A function that throws where options do not fit the input.
using InputCheck = std::function<void(const interfaces::InputFacts&)>;

/// Returns how the interfaces of what is resampled are reconstructed.
interfaces::ReconstructionOptions reconstruction_of(const ResampleOptions& options);

/// Reads an input, calls `check`, and reconstructs its interfaces, or mends them where they are given. Throws
/// WrongStep where the check throws.
LoadedInput load_input(const InputOptions& options, const interfaces::ReconstructionOptions& reconstruction,
                       Progress& progress, const InputCheck& check = {});

/// Returns the numbers of materials, given by name, in a list of names. Throws Error, in the name of
/// `source`, for a name that is not in the list; `whose` says whose materials were expected.
IdVector<MaterialId, MaterialId> material_numbers(const IdVector<MaterialId, std::string>& names,
                                                  const IdVector<MaterialId, std::string>& among,
                                                  std::string_view source, std::string_view whose);

}  // namespace adamas::workflow
