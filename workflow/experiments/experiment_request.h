#pragma once

#include <string>
#include <vector>

#include "adamas/experiment.h"
#include "interfaces/api/error_targets.h"

namespace adamas::workflow {

/// Throws Error where the options do not suit the input.
void check_experiment(const ExperimentOptions& options, const interfaces::InputFacts& input);

/// Returns the interface errors of the curve from coarse to fine, in units of length; `target`, the interface
/// error that is wanted, is among them.
std::vector<double> curve_errors(const ExperimentOptions& options, const interfaces::InputFacts& input,
                                 double target);

/// Returns the options of the experiment's series.
ResampleSeriesOptions series_options(const ExperimentOptions& options);

}  // namespace adamas::workflow
