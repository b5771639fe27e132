#pragma once

namespace adamas {

/// Lengths of cells above the one and coordinates below the other: so products of four lengths neither
/// overflow nor underflow, their rounding errors included.
inline constexpr double kLeastLength = 1e-50;
inline constexpr double kGreatestCoordinate = 1e50;

}  // namespace adamas
