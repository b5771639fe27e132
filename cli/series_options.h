#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "adamas/series_output.h"
#include "cli/command.h"

namespace adamas::cli {

/// The options -o and --steps of a command that makes a series, or only the last state of it.
struct SeriesOutputOptions {
  std::string output;
  std::optional<std::size_t> steps;
};

/// Adds --steps with this description.
void add_series_steps(const Command& command, std::optional<std::size_t>& steps,
                      const std::string& description);
/// Adds --steps and -o. `single`: a text with the extensions of a single file.
void add_series_output(const Command& command, const std::string& single, const SeriesForm& form,
                       SeriesOutputOptions& options);

/// Adds the options of a film of the meshes of a series, without its plane and its field. `rate`: the frames
/// per second.
void add_film_options(const Command& command, std::filesystem::path& file, std::optional<double>& rate);

}  // namespace adamas::cli
