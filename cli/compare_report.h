#pragma once

#include <string>
#include <vector>

#include "adamas/compare.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Prints the plan of a comparison, and the greatest time of other generators. `labels`: whether the input
/// has labels.
void print_plan(const CompareOptions& options, bool labels, Console& console);

/// Prints the heads of the columns of the table of rows.
void print_comparison_header(Console& console);
/// Prints a row with its remarks, and notes the errors that it did not reach.
void print_comparison_row(const ComparisonRow& row, Console& console);

/// Returns the rows for `--json`.
Figures comparison_figures(const std::vector<ComparisonRow>& rows);
/// Returns the rows as comma-separated values.
std::string comparison_csv(const std::vector<ComparisonRow>& rows);

}  // namespace adamas::cli
