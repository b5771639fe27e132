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

/// The options that say how to simplify interfaces, as text.
struct SimplificationText {
  std::string error;
  bool smooth = false;
};

/// `of_what`: what is simplified, for the help.
void add_simplification_options(const Command& command, SimplificationText& text, const std::string& of_what);

/// The options with their values checked, before the input is known.
struct SimplificationRequest {
  /// Throws UsageError.
  explicit SimplificationRequest(const SimplificationText& text);
  /// Throws UsageError for an error that says nothing in this domain.
  void check(const InputFacts& input) const;
  [[nodiscard]] bool wanted() const { return error.has_value(); }

  std::optional<ErrorTarget> error;
  bool smooth = false;
};

/// Simplifies the interfaces of a source and prints what came of it; the figures are put into `figures`.
interfaces::SimplifiedInterfaces simplify_and_print(const interfaces::ResamplingSource& source,
                                                    const SimplificationRequest& request, Figures& figures,
                                                    Console& console);

}  // namespace adamas::cli
