#pragma once

#include <string>
#include <vector>

#include "adamas/reconstruct.h"
#include "cli/console.h"
#include "cli/figures.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::cli {

/// Prints how many triangles each interface has, "A | B", and how large it is where `areas` are wanted; the
/// figures are a list of interfaces.
Figures print_interfaces(const std::vector<InterfaceArea>& interfaces,
                         const std::vector<std::string>& materials, bool areas, bool print, Console& console);

/// Prints the volumes that given interfaces enclose, where they are closed; the figures are a list of
/// materials with `key` for the volume.
Figures print_network_volumes(const interfaces::ResamplingSource& source, const char* key, bool print,
                              Console& console);

/// As print_interfaces for given interfaces, with their areas in the domain.
Figures print_interface_areas(const interfaces::ResamplingSource& source, bool print, Console& console);

}  // namespace adamas::cli
