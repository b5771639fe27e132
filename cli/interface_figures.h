#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/reconstruct.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Prints the number of triangles of each interface, "A | B", and its area if `areas` is set. Returns a list
/// of interfaces as figures.
Figures print_interfaces(const std::vector<InterfaceArea>& interfaces,
                         const std::vector<std::string>& materials, bool areas, bool print, Console& console);

/// The names of materials and the volumes that given interfaces enclose; none where they are not closed.
using EnclosedVolumes = std::vector<std::pair<std::string, std::optional<double>>>;

/// Prints these volumes, and notes where they are not known of the interfaces that `source` names; the
/// figures are a list of materials, with volumes by that key.
Figures print_enclosed_volumes(const EnclosedVolumes& materials, const std::string& key,
                               const std::string& source, bool print, Console& console);

}  // namespace adamas::cli
