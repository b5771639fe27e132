#pragma once

#include <string>

#include "workflow/slices/slice_steps.h"

namespace adamas::workflow {

/// Cuts the steps of a series and writes a picture or polygons of each, or a film, with one scale of colours
/// and one legend for all of them. Throws Error.
SliceReport slice_series(const SliceRequest& request, const SliceSteps& steps, const std::string& output,
                         OutputSet& outputs, Progress& progress);

}  // namespace adamas::workflow
