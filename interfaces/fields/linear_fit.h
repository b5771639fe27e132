#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// Value at the origin of the linear function that fits `values` at `offsets` in the sense of least squares,
/// weighted by the inverse square of the distance. `values[i * components + c]` is component c at offset i;
/// none at the origin. Directions in which the offsets do not spread get no slope; no offsets give NaN. Exact
/// for linear functions.
void fit_linear_at_origin(const std::vector<Vec3>& offsets, const std::vector<double>& values,
                          std::size_t components, std::span<double> out);

}  // namespace adamas
