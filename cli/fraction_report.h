#pragma once

#include <string>
#include <vector>

#include "adamas/fractions.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Prints what was found of volume fractions: how blurred they are, their errors, cells that are off, areas,
/// and dispersed volumes, which are noted. `source`: for notes.
void print_findings(const FractionFindings& findings, const std::vector<std::string>& materials,
                    const std::string& source, Console& console);
/// The same as figures.
Figures finding_figures(const FractionFindings& findings, const std::vector<std::string>& materials);

}  // namespace adamas::cli
