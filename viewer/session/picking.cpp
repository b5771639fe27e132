#include "viewer/session/picking.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

/// Whether a ray enters a box, widened a little.
bool meets(const Ray& ray, const Box3& box) {
  double from = 0, to = std::numeric_limits<double>::infinity();
  const double margin = 1e-6 * box.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] - margin - ray.origin[axis],
                 high = box.max[axis] + margin - ray.origin[axis];
    if (ray.direction[axis] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low / ray.direction[axis], b = high / ray.direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

/// The intersection of a ray with a triangle: the distance, and the weights of the second and third corner
/// (Moeller and Trumbore 1997).
struct Meeting {
  double distance, second, third;
  bool is_front;
};

std::optional<Meeting> meeting(const Ray& ray, const std::array<Vec3, 3>& corners) {
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
  const Vec3 across = cross(ray.direction, b);
  const double determinant = dot(a, across);
  if (determinant == 0) return std::nullopt;
  const Vec3 from = ray.origin - corners[0];
  const double second = dot(from, across) / determinant;
  const Vec3 other = cross(from, a);
  const double third = dot(ray.direction, other) / determinant;
  const double along = dot(b, other) / determinant;
  if (!(second >= 0 && third >= 0 && second + third <= 1 && along >= 0)) return std::nullopt;
  return Meeting{along, second, third, determinant > 0};
}

}  // namespace

Ray ray_through(const Viewpoint& viewpoint, double x, double y) {
  const auto [forward, right, up] = ViewAxes(viewpoint);
  const double across = 2 * x / viewpoint.width_pixels - 1, upwards = 1 - 2 * y / viewpoint.height_pixels;
  const double aspect = static_cast<double>(viewpoint.width_pixels) / viewpoint.height_pixels;
  if (viewpoint.height > 0) {
    const double half = viewpoint.height / 2;
    return {
        viewpoint.eye + (half * aspect * across) * right + (half * upwards) * up + viewpoint.near * forward,
        forward};
  }
  const double slope = std::tan(viewpoint.field_of_view / 2);
  const Vec3 way = forward + (slope * aspect * across) * right + (slope * upwards) * up;
  return {viewpoint.eye + viewpoint.near * way, normalized(way)};
}

std::optional<std::array<double, 2>> in_picture(const Viewpoint& viewpoint, const Vec3& place) {
  const auto [forward, right, up] = ViewAxes(viewpoint);
  const Vec3 from_eye = place - viewpoint.eye;
  const double depth = dot(from_eye, forward);
  if (depth <= viewpoint.near) return std::nullopt;
  const double half =
      viewpoint.height > 0 ? viewpoint.height / 2 : depth * std::tan(viewpoint.field_of_view / 2);
  const double scale = 0.5 * viewpoint.height_pixels / half;
  return std::array{0.5 * viewpoint.width_pixels + scale * dot(from_eye, right),
                    0.5 * viewpoint.height_pixels - scale * dot(from_eye, up)};
}

std::optional<Hit> pick(std::span<const DrawnPart> parts, const Ray& ray, const std::optional<Plane>& clip) {
  std::optional<Hit> nearest;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const DrawnMesh& mesh = *parts[p].mesh;
    if (mesh.is_lines || !meets(ray, mesh.box)) continue;
    const Ray local{ray.origin - mesh.origin, ray.direction};
    for (std::size_t t = 0; 3 * t + 2 < mesh.indices.size(); ++t) {
      std::array<Vec3, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) corners[c] = mesh.place(mesh.indices[3 * t + c], parts[p].isovalue);
      const std::optional<Meeting> found = meeting(local, corners);
      if (!found || (nearest && found->distance >= nearest->distance)) continue;
      const Vec3 place = ray.origin + found->distance * ray.direction;
      if (clip && parts[p].style.is_clipped && dot(place - clip->origin, clip->normal) > 0) continue;
      const auto value = [&](std::size_t c) {
        if (mesh.vertices.empty()) return std::numeric_limits<double>::quiet_NaN();
        const DrawnMesh::Vertex& vertex = mesh.vertices[mesh.indices[3 * t + c]];
        return static_cast<double>(found->is_front ? vertex.front_value : vertex.back_value);
      };
      nearest = Hit{
          p,
          t,
          place,
          found->distance,
          found->is_front,
          (1 - found->second - found->third) * value(0) + found->second * value(1) + found->third * value(2)};
    }
  }
  return nearest;
}

}  // namespace adamas::viewer
