#pragma once

#include "adamas/experiment.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Returns the keys of metrics.json, without times and memory of the run.
Figures experiment_figures(const ExperimentRecord& record);

}  // namespace adamas::cli
