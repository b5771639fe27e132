#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adamas/experiment.h"
#include "cli/command.h"
#include "cli/film_options.h"
#include "cli/input_options.h"
#include "cli/picture_options.h"

namespace adamas::cli {

/// The options of `experiment`: those of the library, and texts that are converted to such options.
struct ExperimentArguments {
  std::vector<std::string> inputs;  ///< one file, or the steps of a series
  InputArguments input;
  std::string generate;
  std::optional<std::array<std::size_t, 3>> dimensions;
  std::optional<std::uint64_t> seed;
  PictureOptions pictures;
  FilmOptions film;
  ExperimentOptions experiment;  ///< all other options
  std::string output;
  bool overwrite = false;
};

void add_experiment_options(const Command& command, ExperimentArguments& arguments);

/// Returns the options of the library, with the input's name. Throws Error (kUsage) for options without
/// effect.
ExperimentOptions to_experiment_options(ExperimentArguments& arguments);

}  // namespace adamas::cli
