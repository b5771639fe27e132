#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::interfaces {

/// Evaluates, at the origin, the linear function that fits `values` at `offsets` by least squares, weighted
/// by 1 / (d^2 + softening^2) with the distance d from the origin. `values[i * components + c]` is component
/// c at offset i; without softening, no offset may be zero. The function has no slope in directions in which
/// the offsets do not extend; without offsets, the result is NaN. Linear functions are reproduced exactly.
void fit_linear_at_origin(const std::vector<Vec3>& offsets, const std::vector<double>& values,
                          std::size_t components, double softening, std::span<double> out);

}  // namespace adamas::interfaces
