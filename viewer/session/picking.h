#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "adamas/geometry.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/contents/drawn_mesh.h"

namespace adamas::viewer {

/// The points origin + t * direction, t >= 0.
struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< unit vector
};

/// The ray of sight through a place of the picture, starting at the near plane. `x`, `y`: pixels from the
/// upper left corner.
Ray ray_through(const isosurface::Viewpoint& viewpoint, double x, double y);

/// The place of a point in the picture, in pixels from the upper left corner; empty unless the point is
/// behind the near plane.
std::optional<std::array<double, 2>> in_picture(const isosurface::Viewpoint& viewpoint, const Vec3& place);

/// The first triangle that a ray meets.
struct Hit {
  std::size_t part = 0, triangle = 0;
  Vec3 place;
  double distance = 0;
  bool is_front = true;  ///< whether the ray meets the triangle's front side
  double value = 0;      ///< the value of that side at the place; NaN if it has none
};

/// Finds the nearest triangle of the parts on a ray. If a plane clips parts, triangles in front of it are
/// ignored.
std::optional<Hit> pick(std::span<const DrawnPart> parts, const Ray& ray, const std::optional<Plane>& clip);

}  // namespace adamas::viewer
