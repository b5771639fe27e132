#pragma once

#include "adamas/experiment.h"
#include "core/data/interface_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::workflow {

/// Resamples a source; `mesh` and `interfaces`, unless they are null, receive the result.
ExperimentRun run_resampler(const interfaces::ResamplingSource& source,
                            const interfaces::ResamplingOptions& options, Progress& progress,
                            interfaces::ResampledMesh* mesh = nullptr, InterfaceMesh* interfaces = nullptr);

}  // namespace adamas::workflow
