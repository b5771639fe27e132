#pragma once

#include <string>
#include <vector>

#include "adamas/resample.h"
#include "adamas/series.h"
#include "cli/command.h"
#include "cli/film_options.h"
#include "cli/input_options.h"

namespace adamas::cli {

/// The outputs of `resample` for a series.
struct SeriesFiles {
  std::string series;               ///< the first of the inputs
  std::string mesh;                 ///< F.pvd, or a pattern of names
  std::vector<std::string> curves;  ///< .csv or pictures
  FilmOptions film;
};

/// Resamples the steps of a series, each from the mesh of the step before, and prints the results. Throws
/// Error.
void resample_series(const InputArguments& input, const std::vector<SeriesEntry>& steps,
                     const ResampleOptions& resampling, const SeriesFiles& files, Session& session);

}  // namespace adamas::cli
