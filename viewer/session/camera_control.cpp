#include "viewer/session/camera_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace adamas::viewer {

using namespace isosurface;
using namespace picture;

namespace {

/// The least angle between a turntable's line of sight and the vertical, in radians.
constexpr double kLeastTilt = 0.01;
/// Objects nearer to the eye than this part of the distance to the target are not shown.
constexpr double kNearPart = 1e-3;

Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
  return std::cos(angle) * v + std::sin(angle) * cross(axis, v) + (1 - std::cos(angle)) * dot(axis, v) * axis;
}

/// The length in space of a pixel at the target.
double length_of_pixel(const Viewpoint& viewpoint) {
  const double height = viewpoint.height > 0 ? viewpoint.height
                                             : 2 * distance(viewpoint.eye, viewpoint.target) *
                                                   std::tan(viewpoint.field_of_view / 2);
  return height / viewpoint.height_pixels;
}

Viewpoint at_distance(Viewpoint viewpoint, double distance) {
  viewpoint.eye = viewpoint.target - distance * normalized(viewpoint.target - viewpoint.eye);
  viewpoint.near = kNearPart * distance;
  return viewpoint;
}

Viewpoint moved(Viewpoint viewpoint, const Vec3& way) {
  viewpoint.eye += way;
  viewpoint.target += way;
  return viewpoint;
}

/// The angle by which the line of sight may turn towards or away from the z axis, so that it stays away from
/// the axis.
double allowed_tilt(const Vec3& forward, double wanted_turn) {
  const double now = std::acos(std::clamp(forward.z, -1.0, 1.0));
  return std::clamp(now + wanted_turn, kLeastTilt, std::numbers::pi - kLeastTilt) - now;
}

}  // namespace

Viewpoint rotated(const Viewpoint& viewpoint, CameraMode mode, double right, double down) {
  const double angle = std::numbers::pi / viewpoint.height_pixels;
  Viewpoint result = viewpoint;
  const ViewAxes axes(viewpoint);
  const Vec3 offset = viewpoint.eye - viewpoint.target;
  if (mode == CameraMode::kTrackball) {
    const auto turn = [&](const Vec3& v) {
      return turned(turned(v, axes.up, -angle * right), axes.right, -angle * down);
    };
    result.eye = viewpoint.target + turn(offset);
    result.up = turn(axes.up);
    return result;
  }
  constexpr Vec3 kUp{0, 0, 1};
  // A right-handed rotation about the right axis raises the line of sight.
  const double lift = -allowed_tilt(axes.forward, angle * down);
  const auto turn = [&](const Vec3& v) { return turned(turned(v, axes.right, lift), kUp, -angle * right); };
  result.up = kUp;
  if (mode == CameraMode::kFly) {
    result.target = viewpoint.eye - turn(offset);
  } else {
    result.eye = viewpoint.target + turn(offset);
  }
  return result;
}

Viewpoint panned(const Viewpoint& viewpoint, double right, double down) {
  const ViewAxes axes(viewpoint);
  const double length = length_of_pixel(viewpoint);
  return moved(viewpoint, length * (-right * axes.right + down * axes.up));
}

Viewpoint zoomed(const Viewpoint& viewpoint, double steps) {
  const double factor = std::pow(0.9, std::clamp(steps, -100.0, 100.0));
  if (viewpoint.height > 0) {
    Viewpoint result = viewpoint;
    result.height *= factor;
    return result;
  }
  return at_distance(viewpoint, factor * distance(viewpoint.eye, viewpoint.target));
}

Viewpoint flown(const Viewpoint& viewpoint, double forward, double right, double up) {
  const ViewAxes axes(viewpoint);
  return moved(viewpoint, distance(viewpoint.eye, viewpoint.target) *
                              (forward * axes.forward + right * axes.right + up * axes.up));
}

Viewpoint showing_all(const Viewpoint& viewpoint, const Box3& box) {
  Viewpoint result = viewpoint;
  const Vec3 offset = viewpoint.eye - viewpoint.target;
  result.target = box.center();
  result.eye = result.target + offset;
  const double radius = std::max(0.5 * box.diagonal(), 1e-12 * norm(box.center()) + 1e-300);
  const double aspect = static_cast<double>(viewpoint.width_pixels) / viewpoint.height_pixels;
  const double slope = std::tan(viewpoint.field_of_view / 2) * std::min(1.0, aspect);
  result = at_distance(result, radius / std::sin(std::atan(slope)));
  if (viewpoint.height > 0) {
    result.height = 2 * radius / std::min(1.0, aspect);
    // In parallel projection nothing of the box may lie behind the eye.
    result = at_distance(result, std::max(distance(result.eye, result.target), 2 * radius));
  }
  return result;
}

Viewpoint looking(const Viewpoint& viewpoint, const Vec3& direction, const Vec3& up) {
  Viewpoint result = viewpoint;
  result.eye = viewpoint.target - distance(viewpoint.eye, viewpoint.target) * normalized(direction);
  result.up = up;
  return result;
}

Viewpoint sized_as(const Viewpoint& viewpoint, const Viewpoint& other) {
  Viewpoint result = viewpoint;
  result.width_pixels = other.width_pixels;
  result.height_pixels = other.height_pixels;
  return result;
}

Viewpoint with_projection(const Viewpoint& viewpoint, bool is_parallel) {
  Viewpoint result = viewpoint;
  if (is_parallel == (viewpoint.height > 0)) return result;
  const double slope = 2 * std::tan(viewpoint.field_of_view / 2);
  if (is_parallel) {
    result.height = slope * distance(viewpoint.eye, viewpoint.target);
    return result;
  }
  result.height = 0;
  return at_distance(result, viewpoint.height / slope);
}

Viewpoint between(const Viewpoint& from, const Viewpoint& to, double t) {
  if (t <= 0) return from;
  if (t >= 1) return to;
  const auto mixed = [t](const Vec3& a, const Vec3& b) { return (1 - t) * a + t * b; };
  const auto direction = [&](const Vec3& a, const Vec3& b) {
    const Vec3 m = mixed(normalized(a), normalized(b));
    return norm(m) > 1e-6 ? normalized(m) : normalized(t < 0.5 ? a : b);
  };
  const double from_distance = distance(from.eye, from.target), to_distance = distance(to.eye, to.target);
  Viewpoint result = from;
  result.target = mixed(from.target, to.target);
  const double apart = std::exp((1 - t) * std::log(from_distance) + t * std::log(to_distance));
  result.eye = result.target + apart * direction(from.eye - from.target, to.eye - to.target);
  result.up = direction(from.up, to.up);
  const Vec3 forward = normalized(result.target - result.eye);
  if (norm(cross(forward, result.up)) < 1e-3) result.up = t < 0.5 ? from.up : to.up;
  if (norm(cross(forward, result.up)) < 1e-3) result.up = ViewAxes(from).right;
  result.height = from.height > 0 && to.height > 0 ? (1 - t) * from.height + t * to.height : to.height;
  result.near = kNearPart * apart;
  return result;
}

Viewpoint along(const std::vector<Viewpoint>& path, std::size_t frame, std::size_t frames) {
  const std::size_t parts = std::max<std::size_t>(2, frames) - 1;
  // The position is computed in whole numbers, so that frames that coincide with a viewpoint are exactly that
  // viewpoint.
  const std::size_t way = frame * (path.size() - 1), below = way / parts;
  const double part = static_cast<double>(way % parts) / static_cast<double>(parts);
  return between(path[below], path[std::min(below + 1, path.size() - 1)], part);
}

}  // namespace adamas::viewer
