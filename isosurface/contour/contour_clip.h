#pragma once

#include <span>

#include "core/geometry/plane.h"
#include "core/geometry/vec3.h"
#include "isosurface/contour/contour.h"

namespace adamas {

/// Leaves of a contour what lies in the box. Where one of its planes cuts an edge there is one new point,
/// which all triangles at the edge share: the surface stays closed but for the planes. Points without a
/// triangle go.
///
/// With the spacing of samples no triangle is left that has no area in single precision: points that it
/// hardly tells from a plane, at most 1/8192 of the spacing from it, are moved into it, and neighbours in a
/// plane that are as near to each other become one. Rounding alone puts planes of samples beside points that
/// lie in them. Points on edges with parameters of 1/1024 or more are farther from each other than that.
void clip_contour(Contour& contour, const Box3& box, const Vec3& spacing = {});
/// The same of what lies on the side of all planes that their normals point away from. Points near a plane
/// that is not across an axis count as in it and stay where they are.
void clip_contour(Contour& contour, std::span<const Plane> sides, const Vec3& spacing = {});

}  // namespace adamas
