#include "cli/series_options.h"

#include <fmt/format.h>

#include "cli/option_values.h"

namespace adamas::cli {

void add_series_steps(const Command& command, std::optional<std::size_t>& steps,
                      const std::string& description) {
  command
      .add_converted("--steps", description,
                     [&steps](const std::string& option, const std::string& text) {
                       steps = parse_count(option, text, 2);
                     })
      .type_name("N");
}

void add_series_output(const Command& command, const std::string& single, const SeriesForm& form,
                       SeriesOutputOptions& options) {
  add_series_steps(
      command, options.steps,
      fmt::format("How many data sets a series has, the first at the start (default {})", form.steps));
  command
      .add_option("-o,--output", options.output, fmt::format("The last data: {}; or a series: .pvd", single))
      .required()
      .type_name("FILE");
}

}  // namespace adamas::cli
