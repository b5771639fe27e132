#pragma once

#include <span>

#include "core/geometry/plane.h"
#include "core/geometry/vec3.h"
#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// Cuts off what of a contour lies outside the box. Where a plane of the box cuts an edge there is one new
/// point, which all triangles at the edge share, so that the surface stays closed except in the planes.
/// Points that no triangle needs are removed.
///
/// Where the spacing of samples is given no triangle is left without an area in single precision: points that
/// are nearer to a plane than rounding in single precision may tell, at most 1/8192 of the spacing, are moved
/// into it, and neighbours in a plane that are as near to each other become one. Rounding alone puts planes
/// of samples beside points that lie in them. Points on edges are farther from each other than that where
/// their parameters are 1/1024 or more.
void clip_contour(Contour& contour, const Box3& box, const Vec3& spacing = {});
/// The same of what lies on the side of all planes that their normals point away from. Points near a plane
/// that is not across an axis count as in it and stay where they are.
void clip_contour(Contour& contour, std::span<const Plane> sides, const Vec3& spacing = {});

}  // namespace adamas::isosurface
