#pragma once

#include <cstddef>
#include <span>

namespace adamas::interfaces {

/// Returns the distance of the origin from the convex hull of points with `dimension` coordinates each, which
/// are consecutive (P. Wolfe, Finding the nearest point in a polytope, Math. Programming 11, 1976). The
/// result is too small by round-off at most; it is infinite without points.
double distance_from_hull(std::span<const double> points, std::size_t dimension);

}  // namespace adamas::interfaces
