#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "isosurface/gradients/gradient_estimator.h"

namespace adamas::isosurface {

/// The bytes of DirectionCode::kOctahedral.
using OctahedralCode = std::array<std::uint8_t, 2>;

/// The codes of many directions at once: code i is encode_direction of (x[i], y[i], z[i]), to the bit. All
/// spans have the same length.
void encode_octahedral(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                       std::span<OctahedralCode> codes);
void encode_octahedral(std::span<const Gradient> gradients, std::span<OctahedralCode> codes);

}  // namespace adamas::isosurface
