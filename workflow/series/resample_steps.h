#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "adamas/resample_series.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas::workflow {

/// Functions that are called for the steps of a series, by number.
struct StepActions {
  /// Receives the mesh of each step, which it may read and must not change, and the colours that materials
  /// have so far.
  std::function<void(std::size_t, interfaces::ResampledMesh&, const MaterialColours&)> finish;
  /// Is called for each step that is left out.
  std::function<void(std::size_t)> leave_out;
};

/// Reads and resamples the steps of a series one after another. Throws Error as resample_series() does.
ResampledSeries resample_steps(const std::vector<SeriesEntry>& steps, const ResampleSeriesOptions& options,
                               const StepActions& actions, Progress& progress);

}  // namespace adamas::workflow
