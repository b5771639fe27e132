#include "interfaces/library/resample_options.h"

#include "core/base/error.h"

namespace adamas::interfaces {

ResamplingOptions to_resampling_options(const ResampleOptions& options, const InputFacts& input) {
  ResamplingOptions result;
  result.interface_error = interface_error_of("--interface-error", options.interface_error, input);
  result.field_errors = field_errors_of(options.field_errors, input);
  if (options.volume_error && !(*options.volume_error > 0 && *options.volume_error < 1))
    wrong_usage("--volume-error: expected a part above 0 and less than 1, found {}", *options.volume_error);
  result.max_tetrahedra = options.max_tetrahedra;
  result.ghost = options.ghost;
  result.distance = options.distance;
  result.conserve = options.conserve;
  result.volume_error = options.volume_error;
  return result;
}

void check_options(const ResampleOptions& options, const InputFacts& input) {
  static_cast<void>(to_resampling_options(options, input));
}

void check_volumes(const ResampleOptions& options, const ResamplingSource& source) {
  if ((options.conserve || options.volume_error) && source.body_volumes.empty() &&
      !source.network->triangles().empty())
    fail("{}: {}: expected interfaces that enclose volumes, found open ones", source.name,
         options.conserve ? "--conserve" : "--volume-error");
}

ResamplingOptions to_resampling_options(const ResampleOptions& options, const ResamplingSource& source) {
  ResamplingOptions result = to_resampling_options(options, facts_of(source));
  check_volumes(options, source);
  return result;
}

}  // namespace adamas::interfaces
