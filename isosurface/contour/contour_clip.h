#pragma once

#include <span>

#include "core/geometry/plane.h"
#include "core/geometry/vec3.h"
#include "isosurface/contour/contour.h"

namespace adamas {

/// Leaves of a contour what lies in the box. Where one of its planes cuts an edge there is one new point,
/// which all triangles at the edge share: the surface stays closed but for the planes. Points without a
/// triangle go.
void clip_contour(Contour& contour, const Box3& box);
/// The same of what lies on the side of all planes that their normals point away from.
void clip_contour(Contour& contour, std::span<const Plane> sides);

}  // namespace adamas
