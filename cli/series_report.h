#pragma once

#include <string>
#include <vector>

#include "cli/left_out_steps.h"
#include "cli/series_run.h"
#include "core/picture/html_report.h"

namespace adamas::cli {

/// What the steps of a series have in common, for their figures and curves.
struct SeriesRecord {
  std::vector<interfaces::FieldInfo> fields;
  std::string density;  ///< the field whose integral is mass; empty for none
  std::vector<SeriesStep> steps;
  LeftOutSteps left_out;  ///< that cannot be read
};

/// The interfaces' distance, certified and attained; NaN where it was not measured.
double certified_error(const SeriesStep& step);
double attained_error(const SeriesStep& step);

/// For `--json`: a row per step, with the keys of a single run, its number, its time and its file.
Figures series_figures(const SeriesRecord& record);
/// Errors, volumes and masses over time: a line per step, as comma-separated values.
std::string series_csv(const SeriesRecord& record);
/// The same as tables; the first tells sizes and errors, the second how far volumes and masses are off.
std::vector<TextTable> series_tables(const SeriesRecord& record);
void print_series(const SeriesRecord& record, Console& console);

}  // namespace adamas::cli
