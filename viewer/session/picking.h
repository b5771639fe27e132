#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "core/geometry/vec3.h"
#include "isosurface/view/viewpoint.h"
#include "viewer/document/drawn_mesh.h"

namespace adamas::viewer {

/// The points origin + t * direction, t >= 0.
struct Ray {
  Vec3 origin;
  Vec3 direction;  ///< of length 1
};

/// What a place of the picture shows, from the near plane on; in pixels from the upper left corner.
Ray ray_through(const isosurface::Viewpoint& viewpoint, double x, double y);

/// Where a place is in the picture, in pixels from the upper left corner; none for what is not behind the
/// near plane.
std::optional<std::array<double, 2>> in_picture(const isosurface::Viewpoint& viewpoint, const Vec3& place);

/// What a ray meets first.
struct Hit {
  std::size_t part = 0, triangle = 0;
  Vec3 place;
  double distance = 0;
  bool is_front = true;  ///< it comes to the triangle's front side
  double value = 0;      ///< of that side there; NaN where it has none
};

/// The nearest triangle of the parts on a ray; with a plane, parts that it clips are not met in front of it.
std::optional<Hit> pick(std::span<const DrawnPart> parts, const Ray& ray, const std::optional<Plane>& clip);

}  // namespace adamas::viewer
