#pragma once

#include <optional>
#include <string>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/figures.h"
#include "cli/input_options.h"
#include "cli/option_values.h"
#include "interfaces/simplification/interface_simplification.h"

namespace adamas::cli {

/// The options that say how to simplify interfaces.
struct SimplifyOptions {
  std::optional<ErrorTarget> error;
  bool smooth = false;

  [[nodiscard]] bool wanted() const { return error.has_value(); }
  /// Throws Error where one option needs another.
  void check() const;
  /// Throws Error where the options do not suit the input.
  void check(const interfaces::InputFacts& input) const;
};

/// `of_what`: what is simplified, for the help.
void add_simplification_options(const Command& command, SimplifyOptions& options, const std::string& of_what);

/// Simplifies the interfaces of a source and prints what came of it; the figures are put into `figures`.
interfaces::SimplifiedInterfaces simplify_and_print(const interfaces::ResamplingSource& source,
                                                    const SimplifyOptions& wanted, Figures& figures,
                                                    Console& console);

}  // namespace adamas::cli
