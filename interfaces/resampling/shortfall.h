#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adamas/resample.h"
#include "interfaces/resampling/resample_figures.h"
#include "interfaces/resampling/resampler.h"

namespace adamas::interfaces {

/// Those of the interfaces, of the boundary of the worst material, of junction lines, and of the fields,
/// given their errors in the whole mesh.
std::vector<UnreachedError> unreached_errors(const Resampler& resampler,
                                             const std::vector<FieldFigures>& fields);

/// The shortfall of the interface error, for one of the distances of the certificate; none where that is
/// within it.
std::optional<Shortfall> interface_shortfall(const Resampler& resampler, const InterfaceDistance& distance);

/// The shortfall of a field's error, given its errors in the whole mesh; none where it was reached, or not
/// wanted.
std::optional<Shortfall> field_shortfall(const Resampler& resampler, std::size_t field,
                                         const FieldError& errors);

/// The shortfall of a body's volume, with a point of the body's boundary for a place; none where the error
/// wanted was reached, or none was wanted.
std::optional<Shortfall> volume_shortfall(const Resampler& resampler, const ResampleFigures& measured,
                                          BodyId body);

}  // namespace adamas::interfaces
