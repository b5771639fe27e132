#include "timevarying/api/surface_options.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace adamas::timevarying {

void check_isovalue(double isovalue) {
  if (!std::isfinite(isovalue)) wrong_usage("--isovalue: expected a finite number, found '{}'", isovalue);
}

void check_isovalues(std::span<const double> isovalues) {
  for (auto isovalue = isovalues.begin(); isovalue != isovalues.end(); ++isovalue) {
    check_isovalue(*isovalue);
    if (std::find(isovalues.begin(), isovalue, *isovalue) != isovalue)
      wrong_usage("--isovalue: expected another value each time, found {} twice", *isovalue);
  }
}

void check_surface_error(const ErrorTarget& error) {
  if (!std::isfinite(error.value) || error.value < 0)
    wrong_usage("--error: expected a number of at least 0, found '{}'", error.value);
}

double surface_error(const ErrorTarget& error, const VolumeGrid& grid) {
  check_surface_error(error);
  return error.absolute(grid.frame_box().diagonal(),
                        std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z}));
}

}  // namespace adamas::timevarying
