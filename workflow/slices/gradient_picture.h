#pragma once

#include <string>

#include "adamas/slice_files.h"

namespace adamas::workflow {

/// Draws the directions of a store's gradients, for each pixel that of the nearest sample: red, green and
/// blue for -1 to 1 along the axes of the grid (the dissertation's figure 4.4), so that grey means no
/// gradient; white is beyond the data. A legend explains it. Writes the picture and returns the part of the
/// pixels without gradient. Throws Error (kUsage) for another output, and Error for a store without gradients
/// and a plane that does not cut it.
double draw_gradients(const SliceRequest& request, const std::string& output, OutputSet& outputs,
                      Progress& progress);

}  // namespace adamas::workflow
