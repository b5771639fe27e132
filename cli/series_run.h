#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adamas/series.h"
#include "cli/experiment_runs.h"
#include "cli/resampling_options.h"

namespace adamas::cli {

/// A step of a series, and what resampling it came to.
struct SeriesStep {
  SeriesEntry entry;
  std::size_t number = 0;  ///< in the whole series
  ExperimentRun run;
  std::vector<interfaces::FieldInfo> fields;         ///< with their ranges
  std::vector<LedgerRow> ledger;                     ///< volumes and masses
  std::optional<interfaces::Adaptation> adaptation;  ///< none for a mesh that was made from the roots
  double processor_seconds = 0;                      ///< of refinement
};

/// Resamples the steps of a series one after another, each from the mesh of the one before.
class SeriesResampler {
 public:
  SeriesResampler(const ResampleOptions& options, Console& console) : options_(options), console_(console) {}

  /// The next step, and its mesh. `density`: the field whose integral is mass; empty for none.
  SeriesStep resample(const SeriesEntry& entry, const workflow::LoadedInput& input,
                      const std::string& density, interfaces::ResampledMesh& mesh);

 private:
  const ResampleOptions& options_;
  Console& console_;
  std::optional<interfaces::Resampler::MeshHierarchy> previous_;
};

}  // namespace adamas::cli
