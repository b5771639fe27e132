#pragma once

#include "cli/console.h"
#include "cli/figures.h"
#include "core/data/interface_mesh.h"
#include "interfaces/network/body_topology.h"
#include "interfaces/source/resampling_source.h"

namespace adamas::cli {

/// In what a body is another one than `before`: "in 2 pieces instead of 1, and its boundary has the Euler
/// characteristic 4 instead of 2".
std::string topology_text(const BodyTopology& before, const BodyTopology& after);

/// Prints how many triangles each interface has, "A | B", and how large it is where `areas` are wanted; the
/// figures are a list of interfaces.
Figures print_interfaces(const InterfaceMesh& mesh, bool areas, Console& console);

/// Prints the volumes that given interfaces enclose, where they are closed; the figures are a list of
/// materials with `key` for the volume.
Figures print_network_volumes(const interfaces::ResamplingSource& source, const char* key, bool print,
                              Console& console);

/// As print_interfaces for given interfaces, with their areas in the domain.
Figures print_interface_areas(const interfaces::ResamplingSource& source, bool print, Console& console);

}  // namespace adamas::cli
