#pragma once

#include <span>

#include "adamas/geometry.h"
#include "core/geometry/plane.h"
#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// Clips a contour to a box. If a plane of the box cuts an edge, there is one new point, which all triangles
/// at the edge share, so that the surface stays closed except in the planes. Points that no triangle needs
/// are removed.
///
/// If the spacing of samples is given, every triangle that is left has an area in single precision. To this
/// end, points that single precision cannot distinguish from a plane, at most 1/8192 of the spacing away, are
/// moved into it, and points in a plane that are as near to each other are merged. (Rounding alone may put
/// planes of samples beside points that lie in them.) Points on edges are farther from each other than that
/// if their parameters are 1/1024 or more.
void clip_contour(Contour& contour, const Box3& box, const Vec3& spacing = {});
/// Clips a contour to the region from which the normals of all planes point away. Points near a plane that is
/// not across an axis count as in it, but are not moved.
void clip_contour(Contour& contour, std::span<const Plane> sides, const Vec3& spacing = {});

}  // namespace adamas::isosurface
