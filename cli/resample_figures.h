#pragma once

#include <vector>

#include "adamas/resample.h"
#include "cli/figures.h"

namespace adamas::cli {

// The functions below make parts of `--json`; a figure that is not known is null.

/// Returns the greatest and the mean errors of one field.
Figures field_error_figures(const ResampleReport::Field& field);
/// Returns the materials' names and their volumes in the input and in a mesh.
Figures volume_figures(const std::vector<ResampleReport::Material>& materials);
/// Returns all keys that describe the mesh.
Figures resample_json(const ResampleReport& report);

/// Returns the names of the materials of a report, by number.
std::vector<std::string> material_names(const ResampleReport& report);

}  // namespace adamas::cli
