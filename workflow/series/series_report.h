#pragma once

#include <string>
#include <vector>

#include "adamas/resample_series.h"
#include "core/picture/plot.h"

namespace adamas::workflow {

/// A curve over time.
struct SeriesCurve {
  std::string name;  ///< the name of its file, without an extension
  std::string caption;
  picture::Plot plot;
};
/// Returns the curves of sizes, errors of interfaces and of fields, volumes and masses, as far as they exist.
std::vector<SeriesCurve> series_curves(const ResampledSeries& record);

}  // namespace adamas::workflow
