#pragma once

#include "cli/console.h"
#include "cli/figures.h"
#include "core/data/interface_mesh.h"
#include "interfaces/source.h"

namespace adamas {

/// Prints how many triangles each interface has, "A | B"; the figures are a list of interfaces.
Figures print_interfaces(const InterfaceMesh& mesh, Console& console);

/// The same for given interfaces, with their areas in the domain.
Figures print_interface_areas(const ResamplingSource& source, bool print, Console& console);

}  // namespace adamas
