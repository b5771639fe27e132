#pragma once

#include <string>
#include <vector>

#include "adamas/reconstruct.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Prints the number of triangles of each interface, "A | B", and its area if `areas` is set. Returns a list
/// of interfaces as figures.
Figures print_interfaces(const std::vector<InterfaceArea>& interfaces,
                         const std::vector<std::string>& materials, bool areas, bool print, Console& console);

}  // namespace adamas::cli
