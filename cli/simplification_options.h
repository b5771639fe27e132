#pragma once

#include <string>

#include "adamas/simplify.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/figures.h"

namespace adamas::cli {

/// Adds the options of simplification. `of_what`: what is simplified, for the help.
void add_simplification_options(const Command& command, SimplifyOptions& options, const std::string& of_what);

/// Throws Error (kUsage) where one option needs another.
void check_simplification(const SimplifyOptions& options);

/// Prints the result of simplification, and notes the errors that were not reached.
void print_simplification(const SimplificationReport& report, Console& console);
/// Returns the result as figures.
Figures simplification_figures(const SimplificationReport& report);

}  // namespace adamas::cli
