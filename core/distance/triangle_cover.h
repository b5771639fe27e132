#pragma once

#include <span>

#include "adamas/geometry.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::inline core {

/// An upper bound of the distance of a convex plane polygon from the surface in the tree. The polygon is cut
/// along the edges of triangles close to it. The bound is the greatest distance of a part from one triangle
/// if all these are at most `enough`, and else infinity. So a polygon beside several triangles of one plane
/// is bounded by its distance from the plane. The number of parts is limited.
double covered_distance(std::span<const Vec3> polygon, const ClosestPointTree& to, double enough);

}  // namespace adamas::inline core
