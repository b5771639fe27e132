#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas::interfaces {

/// Value at the origin of the linear function that fits `values` at `offsets` in the sense of least squares,
/// weighted by 1 / (d^2 + softening^2), d the distance from the origin. `values[i * components + c]` is
/// component c at offset i; without softening, none may be at the origin. Directions in which the offsets do
/// not spread get no slope; no offsets give NaN. Exact for linear functions.
void fit_linear_at_origin(const std::vector<Vec3>& offsets, const std::vector<double>& values,
                          std::size_t components, double softening, std::span<double> out);

}  // namespace adamas::interfaces
