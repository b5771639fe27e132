#include "interfaces/api/resample_options.h"

#include <algorithm>

#include "core/base/error.h"

namespace adamas::interfaces {

namespace {

/// Returns the options with errors in the units of the input; errors relative to the ranges of fields are
/// only right if the ranges are known.
ResamplingOptions with_errors(const ResampleOptions& options, const InputFacts& input) {
  ResamplingOptions result;
  result.interface_error = interface_error_of("--interface-error", options.interface_error, input);
  result.field_errors = field_errors_of(options.field_errors, input);
  if (options.volume_error && !(*options.volume_error > 0 && *options.volume_error < 1))
    wrong_usage("--volume-error: expected a part above 0 and less than 1, found {}", *options.volume_error);
  result.max_tetrahedra = options.max_tetrahedra;
  result.ghost = options.ghost;
  result.distance = options.distance;
  result.volume_error = options.volume_error;
  return result;
}

/// Throws Error if volumes are to be conserved or bounded but open interfaces do not enclose them.
void check_volumes(const ResampleOptions& options, const ResamplingSource& source) {
  const bool conserve = options.conserve.value_or(false);
  if ((conserve || options.volume_error) && source.body_volumes.empty() &&
      !source.network->triangles().empty())
    fail("{}: {}: expected interfaces that enclose volumes, found open ones", source.name,
         conserve ? "--conserve" : "--volume-error");
}

}  // namespace

void check_options(const ResampleOptions& options, const InputFacts& input) {
  static_cast<void>(with_errors(options, input));
}

ResamplingOptions to_resampling_options(const ResampleOptions& options, const ResamplingSource& source) {
  ResamplingOptions result = with_errors(options, facts_of(source));
  check_volumes(options, source);
  // Moves of interfaces change which elements are near them, and may spoil an error of a field that is
  // wanted.
  const bool by_default =
      source.findings.has_value() &&
      std::ranges::none_of(result.field_errors, [](const auto& error) { return error.has_value(); });
  result.conserve = options.conserve.value_or(by_default);
  result.conservation_wanted = options.conserve.value_or(false);
  return result;
}

}  // namespace adamas::interfaces
