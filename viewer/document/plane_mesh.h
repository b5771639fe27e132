#pragma once

#include <functional>
#include <vector>

#include "core/geometry/vec3.h"
#include "viewer/document/drawn_mesh.h"

namespace adamas::viewer {

/// A convex polygon in a plane as triangles with values at a grid of places, which are `step` apart; squares
/// that the polygon's edges cut are cut there. `value(place)`: NaN where there is none. Null for a polygon
/// without area.
SharedMesh plane_mesh(const std::vector<Vec3>& polygon, const Vec3& normal, double step,
                      const std::function<double(const Vec3&)>& value);

}  // namespace adamas::viewer
