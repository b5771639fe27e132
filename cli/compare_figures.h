#pragma once

#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/figures.h"
#include "interfaces/reference/comparison.h"

namespace adamas {

/// The rows of a comparison as a table on stdout, for `--json`, and as CSV.
void print_comparison(const std::vector<ComparedMesh>& rows, const ResamplingSource& source,
                      Console& console);
Figures comparison_figures(const std::vector<ComparedMesh>& rows, const ResamplingSource& source);
std::string comparison_csv(const std::vector<ComparedMesh>& rows, const ResamplingSource& source);

}  // namespace adamas
