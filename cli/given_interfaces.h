#pragma once

#include <memory>

#include "cli/input_options.h"

namespace adamas::cli {

/// Whether the materials come from interface meshes: a network as INPUT, or --interface.
bool has_given_interfaces(const InputOptions& options);

/// The interface mesh that INPUT and --interface give together.
InterfaceMesh read_given_interfaces(const InputOptions& options);

/// Reads and checks the interface meshes and, into `data`, the fields of a gridded INPUT. Its volume
/// fractions are used for fields per material alone; where it has none, all its arrays are fields. Throws
/// Error.
interfaces::ResamplingSource load_given_interfaces(const InputOptions& options,
                                                   std::unique_ptr<MultiMaterialData>& data, Console& console,
                                                   const InputCheck& check);

}  // namespace adamas::cli
