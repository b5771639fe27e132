#pragma once

#include <functional>
#include <vector>

#include "adamas/geometry.h"
#include "viewer/contents/drawn_mesh.h"

namespace adamas::viewer {

/// Makes triangles of a convex polygon in a plane, with values at a grid of places that are `step` apart;
/// squares of the grid are cut by the polygon's edges. `value(place)` returns NaN if there is none. Returns
/// null for a polygon without area.
SharedMesh plane_mesh(const std::vector<Vec3>& polygon, const Vec3& normal, double step,
                      const std::function<double(const Vec3&)>& value);

}  // namespace adamas::viewer
