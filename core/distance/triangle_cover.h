#pragma once

#include <span>

#include "core/distance/closest_point_tree.h"
#include "core/geometry/vec3.h"

namespace adamas::inline core {

/// A bound of the distance of a convex plane polygon from the surface in the tree, found by cutting the
/// polygon along the edges of triangles close to it: where each part is within `enough` of one triangle, the
/// greatest such distance, and else infinity. So a polygon beside several triangles of one plane is bounded
/// by its distance from the plane. Only so many parts are looked at.
double covered_distance(std::span<const Vec3> polygon, const ClosestPointTree& to, double enough);

}  // namespace adamas::inline core
