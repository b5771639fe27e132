#pragma once

#include <filesystem>
#include <vector>

#include "adamas/output_folder.h"
#include "adamas/series.h"
#include "cli/experiment_options.h"
#include "cli/series_report.h"
#include "core/picture/html_report.h"

namespace adamas::cli {

/// Resamples the steps of an experiment's series into the folder: mesh.pvd with the meshes, series.csv, and
/// the film where there is to be one.
SeriesRecord follow_series(const ExperimentOptions& options, const ExperimentRequest& request,
                           const std::vector<SeriesEntry>& steps, const OutputFolder& folder,
                           Console& console);

/// The section of the report about the series; draws its curves into the folder. `film`: its file, empty for
/// none.
void add_series(picture::HtmlReport& report, const SeriesRecord& record, const std::string& film,
                const std::filesystem::path& folder);

}  // namespace adamas::cli
