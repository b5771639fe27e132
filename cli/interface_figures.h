#pragma once

#include <string>
#include <vector>

#include "adamas/reconstruct.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Prints how many triangles each interface has, "A | B", and how large it is where `areas` are wanted; the
/// figures are a list of interfaces.
Figures print_interfaces(const std::vector<InterfaceArea>& interfaces,
                         const std::vector<std::string>& materials, bool areas, bool print, Console& console);

}  // namespace adamas::cli
