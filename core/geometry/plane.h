#pragma once

#include <array>
#include <string>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::inline core {

/// Two-dimensional coordinates in a plane. In a plane perpendicular to an axis they are the space coordinates
/// along the two others, in their order: (y, z), (x, z), (x, y). In other planes they are lengths from the
/// plane's origin; `up` is the projection of z (of y, if z is nearly the normal), and the normal points to
/// the viewer.
struct PlaneFrame {
  Vec3 origin;
  Vec3 right, up;                   ///< unit vectors of the first and the second coordinate
  std::string right_name, up_name;  ///< "x", "y", "z"; "u" and "v" in other planes

  [[nodiscard]] std::array<double, 2> coordinates(const Vec3& p) const {
    return {dot(right, p - origin), dot(up, p - origin)};
  }
};

/// The frame of a plane whose normal is finite and not zero.
PlaneFrame plane_frame(const Plane& plane);

/// The part of a plane inside a box as a convex polygon, found by clipping a large square; empty if they do
/// not meet. A side of the box that lies in the plane counts.
std::vector<Vec3> clip_plane(const Plane& plane, const Box3& box);

/// Area of a plane polygon.
double polygon_area(const std::vector<Vec3>& corners);

}  // namespace adamas::inline core
