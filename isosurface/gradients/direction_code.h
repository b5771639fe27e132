#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/geometry/vec3.h"

namespace adamas::isosurface {

/// How the direction of a gradient is kept in bytes, which are near each other for neighbouring directions.
/// The greatest angles between a direction and what is kept of it stand beside the codes.
enum class DirectionCode : std::uint8_t {
  kOctahedral,     ///< 8 + 8 bits on an octahedron unfolded to a square; 0.64 degrees
  kComponents,     ///< 8 + 8 + 8 bits, one for each component (D 4.3); 0.39 degrees
  kTwoComponents,  ///< 8 bits of x, 7 of y and the sign of z (D 5.3); 5.2 degrees
};

/// How many bytes a direction takes.
constexpr std::size_t direction_bytes(DirectionCode code) {
  return code == DirectionCode::kComponents ? 3 : 2;
}

/// The bytes of the direction of a vector of any length. A vector without a direction (zero or not finite)
/// has a code of its own. Bytes beyond direction_bytes(code) are 0.
std::array<std::uint8_t, 3> encode_direction(DirectionCode code, const Vec3& direction);

/// The unit vector, or zero. Every combination of bytes gives one or the other.
Vec3 decode_direction(DirectionCode code, const std::array<std::uint8_t, 3>& bytes);

}  // namespace adamas::isosurface
