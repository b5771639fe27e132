#include "cli/series_options.h"

#include <fmt/format.h>

#include "cli/option_values.h"

namespace adamas::cli {

void add_series_steps(const Command& command, std::optional<std::size_t>& steps,
                      const std::string& description) {
  command.add_value("--steps", "N", description, steps, parse_count_from_0);
}

void add_series_output(const Command& command, const std::string& single, const SeriesForm& form,
                       SeriesOutputOptions& options) {
  add_series_steps(
      command, options.steps,
      fmt::format("How many data sets a series has, the first at the start (default {})", form.steps));
  command
      .add_option("-o,--output", "FILE", fmt::format("The last data: {}; or a series: .pvd", single),
                  options.output)
      .required();
}

void add_film_options(const Command& command, std::filesystem::path& file, std::optional<double>& rate) {
  const Command film = command.in_group("Film");
  film.add_file("--film", "FILE",
                "Of a series: a film of the meshes in a plane, by ffmpeg: .mp4, .webm or .gif", file);
  film.add_value("--frame-rate", "N", "Steps of the film per second (default 10)", rate, parse_number);
}

}  // namespace adamas::cli
