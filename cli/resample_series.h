#pragma once

#include <string>
#include <vector>

#include "adamas/series.h"
#include "cli/command.h"
#include "cli/input_options.h"
#include "cli/resampling_options.h"
#include "cli/series_film.h"

namespace adamas::cli {

/// What `resample` writes of a series.
struct SeriesOutputs {
  std::string series;               ///< the first of the inputs
  std::string mesh;                 ///< F.pvd, or a pattern of names
  std::vector<std::string> curves;  ///< .csv or pictures
  SeriesFilmText film;
};

/// Resamples the steps of a series, each from the mesh of the one before. Throws Error.
void resample_series(const InputArguments& input, const std::vector<SeriesEntry>& steps,
                     const ResampleOptions& resampling, const SeriesOutputs& outputs, Session& session);

}  // namespace adamas::cli
