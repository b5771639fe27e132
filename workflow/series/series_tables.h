#pragma once

#include "adamas/resample_series.h"

namespace adamas::workflow {

/// Returns the distance between the interfaces of the input and the mesh, certified and attained; NaN where
/// it was not measured.
double certified_error(const ResampledStep& step);
double attained_error(const ResampledStep& step);

}  // namespace adamas::workflow
