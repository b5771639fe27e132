#pragma once

#include <string>
#include <vector>

#include "adamas/compare.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Says what a comparison is going to do, and how long other generators may take. `labels`: whether the input
/// has labels.
void print_plan(const CompareOptions& options, bool labels, Console& console);

/// Prints the heads of the columns of the table of rows.
void print_comparison_header(Console& console);
/// Prints a row, with what has to be known of it, and notes what it did not reach.
void print_comparison_row(const ComparisonRow& row, Console& console);

/// The rows for `--json`.
Figures comparison_figures(const std::vector<ComparisonRow>& rows);
/// The rows as comma-separated values.
std::string comparison_csv(const std::vector<ComparisonRow>& rows);

}  // namespace adamas::cli
