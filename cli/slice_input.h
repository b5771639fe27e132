#pragma once

#include <functional>
#include <string>

#include "cli/input_options.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "workflow/slices/slice_input.h"

namespace adamas::cli {

/// Reads a resampled mesh from .vtu, or the whole one from a saved hierarchy. Throws Error for another mesh.
interfaces::ResampledMesh load_resampled_mesh(const std::string& path, Console& console);

/// Reads the positional input, a resampled mesh, gridded data or given interfaces, and for a mesh the
/// original data or interfaces, where given; the original data get the mesh's order of materials. `check`
/// looks at what was read before long work and may throw. Interfaces of gridded data are reconstructed where
/// they are wanted. Throws Error where the original has another box or other materials than the mesh.
workflow::SliceInput load_slice_input(const InputArguments& options, const std::string& original,
                                      bool with_interfaces,
                                      const std::function<void(const workflow::SliceInput&)>& check,
                                      Console& console);

}  // namespace adamas::cli
