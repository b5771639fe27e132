#pragma once

#include <optional>
#include <string>

#include "adamas/resample_series.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"
#include "workflow/input/loading.h"

namespace adamas::workflow {

/// Resamples the steps of a series one after another, each from the mesh of the step before.
class SeriesResampler {
 public:
  SeriesResampler(const ResampleOptions& options, Progress& progress)
      : options_(options), progress_(progress) {}

  /// Resamples the next step and returns its figures; `mesh` gives access to its mesh. `density`: the field
  /// whose integral is mass; empty: there is none. The caller sets the entry and the number of the step.
  ResampledStep resample(const LoadedInput& input, const std::string& density,
                         interfaces::ResampledMesh& mesh);

 private:
  const ResampleOptions& options_;
  Progress& progress_;
  std::optional<interfaces::Resampler::MeshHierarchy> previous_;
};

}  // namespace adamas::workflow
