#pragma once

#include <filesystem>

#include "adamas/experiment.h"

namespace adamas::workflow {

/// Draws the curves of error against tetrahedra, and those of a series, into the folder, and writes
/// report.html with all pictures; puts the pictures of a series into the record.
void write_experiment_report(ExperimentRecord& record, const std::filesystem::path& folder);

}  // namespace adamas::workflow
