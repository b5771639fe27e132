#pragma once

#include <cstddef>
#include <span>

namespace adamas::interfaces {

/// Distance of the origin from the convex hull of some points of `dimension` coordinates each, one after the
/// other (P. Wolfe, Finding the nearest point in a polytope, Math. Programming 11, 1976). The result
/// is never too small but for round-off, and infinite without points.
double distance_from_hull(std::span<const double> points, std::size_t dimension);

}  // namespace adamas::interfaces
