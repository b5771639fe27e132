#pragma once

#include <string>
#include <vector>

#include "adamas/fractions.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Prints findings about volume fractions: blur, errors, cells that are off, areas, and dispersed volumes,
/// which are noted. `source`: the name in notes.
void print_findings(const FractionFindings& findings, const std::vector<std::string>& materials,
                    const std::string& source, Console& console);
/// Returns these findings as figures.
Figures finding_figures(const FractionFindings& findings, const std::vector<std::string>& materials);

}  // namespace adamas::cli
