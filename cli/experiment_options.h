#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adamas/generate.h"
#include "cli/command.h"
#include "cli/input_options.h"
#include "cli/resampling_options.h"
#include "cli/series_film.h"
#include "cli/surface_picture.h"
#include "core/geometry/plane.h"
#include "core/picture/vec2.h"

namespace adamas::cli {

/// The options of an experiment, as text.
struct ExperimentOptions {
  std::vector<std::string> inputs;  ///< one file, or the steps of a series
  InputArguments input;
  ResampleOptions resampling;
  PictureOptions pictures;
  SeriesFilmText film;
  std::string generate, dimensions, seed;
  std::string title, show, detail, density, published_by, output;
  std::vector<std::string> planes, curve, published;
  bool overwrite = false;
};

void add_experiment_options(const Command& command, ExperimentOptions& options);

/// The options with their values checked, before the input is known.
struct ExperimentRequest {
  /// Throws Error (kUsage).
  explicit ExperimentRequest(const ExperimentOptions& options);
  /// Throws where the options do not suit the input.
  void check(const interfaces::InputFacts& input) const;
  /// Interface errors from coarse to fine, `target` among them.
  [[nodiscard]] std::vector<double> curve(const interfaces::InputFacts& input, double target) const;
  /// The field whose integral is mass: the one asked for, else one called density; empty for none.
  [[nodiscard]] std::string density(const std::vector<interfaces::FieldInfo>& fields,
                                    const std::string& source) const;

  ResampleOptions resampling;
  GeneratedData data;
  std::vector<Plane> planes;
  std::optional<picture::Box2> detail;
  std::vector<ErrorTarget> errors;
  std::vector<std::pair<std::string, double>> published;
  std::string show, density_name;
};

}  // namespace adamas::cli
