#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "cli/experiment_runs.h"
#include "cli/series_report.h"
#include "core/picture/html_report.h"

namespace adamas::cli {

/// A picture of an experiment: a file in its folder, and what it shows.
struct ExperimentPicture {
  std::string file, caption;
};

/// A figure that somebody published, and what the experiment found.
struct PublishedFigure {
  std::string name;
  double published = 0;
  double here = 0;
};

/// Everything that an experiment found, for its figures and its report.
struct ExperimentRecord {
  std::string title;
  std::string input;    ///< what was resampled, in words
  double diagonal = 1;  ///< of the domain
  std::vector<interfaces::FieldInfo> fields;
  std::size_t shown = 0;  ///< the field that slices show; its number, where there are fields
  std::vector<std::pair<std::string, std::size_t>> triangles;  ///< of the input, by "A | B"
  ExperimentRun interfaces;                                    ///< refined for interfaces alone
  std::optional<ExperimentRun> with_fields;                    ///< and for fields, where that was asked for
  std::vector<ExperimentRun> curve;                            ///< from coarse to fine
  bool curve_is_given = false;                                 ///< whether its errors were asked for
  std::vector<LedgerRow> ledger;
  std::string density;       ///< the field whose integral is mass; empty for none
  std::string published_by;  ///< the source of `published`
  std::vector<PublishedFigure> published;
  std::optional<SeriesRecord> series;  ///< where the input is one
  std::string film;                    ///< of the series; a file in the folder, empty for none
  std::vector<ExperimentPicture> input_pictures, mesh_pictures, slices;
  double seconds = 0;

  [[nodiscard]] const ExperimentRun& last() const { return with_fields ? *with_fields : interfaces; }
};

/// The keys of metrics.json.
Figures experiment_figures(const ExperimentRecord& record);

/// The meshes of the input that were asked for, by name: not those of a curve of errors that nobody gave.
/// Without those of the steps of a series.
std::vector<std::pair<std::string, const ExperimentRun*>> wanted_runs(const ExperimentRecord& record);

/// Draws the curves of error against tetrahedra into the folder and writes report.html with all pictures.
void write_experiment_report(const ExperimentRecord& record, const std::filesystem::path& folder);

}  // namespace adamas::cli
