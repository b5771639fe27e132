#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "adamas/geometry.h"
#include "isosurface/gradients/gradient_estimator.h"

namespace adamas::isosurface {

/// The direction of a gradient in two bytes: 8 + 8 bits of a place on an octahedron that is unfolded to a
/// square. Neighbouring directions have near codes; a direction and that of its code are at most 0.64 degrees
/// apart.
using OctahedralCode = std::array<std::uint8_t, 2>;

/// Returns the code of the direction of a vector of any length. A vector without a direction (zero or not
/// finite) has a code of its own.
OctahedralCode encode_octahedral(const Vec3& direction);

/// Returns the direction of a code: a unit vector, or zero. Every combination of bytes gives one or the
/// other.
Vec3 decode_octahedral(const OctahedralCode& code);

/// Encodes many directions at once: code i is that of (x[i], y[i], z[i]) alone, to the bit. All spans have
/// the same length.
void encode_octahedral(std::span<const double> x, std::span<const double> y, std::span<const double> z,
                       std::span<OctahedralCode> codes);
void encode_octahedral(std::span<const Gradient> gradients, std::span<OctahedralCode> codes);

}  // namespace adamas::isosurface
