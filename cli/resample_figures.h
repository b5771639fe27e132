#pragma once

#include "cli/figures.h"
#include "interfaces/resampling/resample_figures.h"

namespace adamas::cli {

// Parts of `--json`; a figure that is not known is null.

/// Greatest and mean errors of one field.
Figures field_error_figures(const interfaces::FieldFigures& errors);
/// The materials' names and their volumes in the input and in a mesh.
Figures volume_figures(const interfaces::ResamplingSource& source,
                       const IdVector<MaterialId, double>& volumes);
/// All keys that tell of the mesh.
Figures resample_json(const interfaces::ResampleFigures& measured, const interfaces::Resampler& resampler);

}  // namespace adamas::cli
