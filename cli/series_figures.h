#pragma once

#include "adamas/resample_series.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Returns a list for `--json`: a row per step, with the keys of a single run, its number, its time and its
/// file.
Figures series_figures(const ResampledSeries& series);
/// For `--json`: the numbers of the steps that were left out.
Figures damaged_steps(const std::vector<LeftOutStep>& steps);
/// Prints sizes and errors over time, and how far volumes and masses are off.
void print_series(const ResampledSeries& series, Console& console);

}  // namespace adamas::cli
