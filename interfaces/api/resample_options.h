#pragma once

#include "adamas/resample.h"
#include "interfaces/api/error_targets.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// Throws Error if an option does not suit the input: an interface error that is not less than the domain's
/// diagonal, or a field that the input does not have. This is checked before long work, when the ranges of
/// fields are unknown.
void check_options(const ResampleOptions& options, const InputFacts& input);

/// Returns the options with errors in the units of the source. Throws Error as check_options() does, and if
/// volumes are to be conserved or bounded but open interfaces do not enclose them. Where the options do not
/// say whether volumes are conserved, those of fractions are, unless errors of fields are wanted.
ResamplingOptions to_resampling_options(const ResampleOptions& options, const ResamplingSource& source);

}  // namespace adamas::interfaces
