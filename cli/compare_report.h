#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/figures.h"
#include "interfaces/reference/comparison.h"

namespace adamas::cli {

/// Says what a comparison is going to do, and how long other generators may take. Of the interface errors
/// only the number need be known.
void print_plan(const interfaces::ComparisonOptions& options, Console& console);

/// The rows of a comparison as a table on stdout, each as soon as it is there, with what has to be known of
/// it.
void print_comparison_header(Console& console);
void print_comparison_row(const interfaces::ComparedMesh& row, const interfaces::ResamplingSource& source,
                          Console& console);

/// The rows for `--json`, and as CSV.
Figures comparison_figures(const std::vector<interfaces::ComparedMesh>& rows,
                           const interfaces::ResamplingSource& source);
std::string comparison_csv(const std::vector<interfaces::ComparedMesh>& rows,
                           const interfaces::ResamplingSource& source);

/// Tetrahedra and seconds against the measured two-sided distance, both logarithmic, side by side.
void write_comparison_picture(const std::filesystem::path& path,
                              const std::vector<interfaces::ComparedMesh>& rows, const std::string& title);

}  // namespace adamas::cli
