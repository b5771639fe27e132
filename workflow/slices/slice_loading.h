#pragma once

#include <functional>
#include <string>

#include "adamas/slice_files.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "workflow/slices/slice_input.h"

namespace adamas::workflow {

/// Reads the input of a request, a resampled mesh, gridded data or given interfaces, and for a mesh the
/// original data or interfaces, where given; the original data get the mesh's order of materials. `check` is
/// called with the input before long work and may throw. Interfaces of gridded data are reconstructed if
/// `with_interfaces` is set. Throws Error where the original has another box or other materials than the
/// mesh.
SliceInput load_slice_input(const SliceRequest& request, bool with_interfaces,
                            const std::function<void(const SliceInput&)>& check, Progress& progress);

/// Returns the name, on the command line, of the first option given that only data on a grid can mean;
/// `shown`: the field that is shown counts too. Empty where there is none.
std::string grid_option(const SliceRequest& request, bool shown);

/// Returns the options for reconstructing interfaces of data on a grid.
interfaces::ReconstructionOptions reconstruction_of(const SliceRequest& request);

}  // namespace adamas::workflow
