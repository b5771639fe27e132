#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::interfaces {

/// Returns for each point the lowest index of a point with the same coordinates.
std::vector<std::uint32_t> weld_points(std::span<const Vec3> points);

}  // namespace adamas::interfaces
