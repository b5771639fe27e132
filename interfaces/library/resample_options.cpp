#include "interfaces/library/resample_options.h"

#include "core/base/error.h"

namespace adamas::interfaces {

void check_options(const ResampleOptions& options, const InputFacts& input) {
  static_cast<void>(interface_error_of("--interface-error", options.interface_error, input));
  static_cast<void>(field_errors_of(options.field_errors, input));
  if (options.volume_error && !(*options.volume_error > 0 && *options.volume_error < 1))
    wrong_usage("--volume-error: expected a part above 0 and less than 1, found {}", *options.volume_error);
}

ResamplingOptions to_resampling_options(const ResampleOptions& options, const ResamplingSource& source) {
  const InputFacts input = facts_of(source);
  check_options(options, input);
  if ((options.conserve || options.volume_error) && source.body_volumes.empty() &&
      !source.network->triangles().empty())
    fail("{}: {}: expected interfaces that enclose volumes, found open ones", input.name,
         options.conserve ? "--conserve" : "--volume-error");
  ResamplingOptions result;
  result.interface_error = interface_error_of("--interface-error", options.interface_error, input);
  result.field_errors = field_errors_of(options.field_errors, input);
  result.max_tetrahedra = options.max_tetrahedra;
  result.ghost = options.ghost;
  result.distance = options.distance;
  result.conserve = options.conserve;
  result.volume_error = options.volume_error;
  return result;
}

}  // namespace adamas::interfaces
