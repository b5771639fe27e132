#pragma once

#include <string>
#include <vector>

#include "cli/series_report.h"
#include "core/picture/plot.h"

namespace adamas::cli {

/// A curve over time, with a name for its file and a caption.
struct SeriesCurve {
  std::string name, caption;
  picture::Plot plot;
};
/// Those of sizes, errors of interfaces and of fields, volumes and masses, as far as there are any.
std::vector<SeriesCurve> series_curves(const SeriesRecord& record);

}  // namespace adamas::cli
