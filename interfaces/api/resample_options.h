#pragma once

#include "adamas/resample.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// Throws Error where an option does not suit the input, before long work and before the ranges of fields are
/// known: an interface error that is not less than the domain's diagonal, or a field that the input does not
/// have.
void check_options(const ResampleOptions& options, const InputFacts& input);

/// The options with errors in the units of the source. Throws Error as check_options does, and where volumes
/// are to be conserved or bounded that open interfaces do not enclose.
ResamplingOptions to_resampling_options(const ResampleOptions& options, const ResamplingSource& source);

}  // namespace adamas::interfaces
