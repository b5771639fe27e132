#include "core/picture/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"

namespace adamas::picture {
namespace {

constexpr double kFieldOfView = 28 * std::numbers::pi / 180;  // angle of the image's longer side

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

Camera::Camera(Projection projection, const Box3& box, const Vec3& direction, double width, double height,
               double margin)
    : projection_(projection),
      near_(-std::numeric_limits<double>::infinity()),
      middle_{0.5 * width, 0.5 * height} {
  const double diagonal = box.diagonal();
  if (!(finite(box.min) && finite(box.max) && diagonal > 0)) {
    fail("camera: expected a finite box with an extent, found ({}, {}, {}) to ({}, {}, {})", box.min.x,
         box.min.y, box.min.z, box.max.x, box.max.y, box.max.z);
  }
  if (!finite(direction) || !(norm(direction) > 0)) {
    fail("camera: expected a direction other than zero, found ({}, {}, {})", direction.x, direction.y,
         direction.z);
  }
  forward_ = normalized(direction);
  const Vec3 sky = std::abs(forward_.z) > 0.999 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  right_ = normalized(cross(forward_, sky));
  up_ = cross(right_, forward_);

  const double half_x = (1 - margin) * middle_.x, half_y = (1 - margin) * middle_.y;
  // These are offsets of the corners from the box's centre, seen from the camera; the image is centred on
  // their extent.
  const Vec3 centre = box.center();
  if (projection == Projection::kOrthographic) {
    Box2 extent;
    for (const Vec3& p : box.corners()) extent.extend({dot(p - centre, right_), dot(p - centre, up_)});
    const Vec2 size = extent.size();
    scale_ = std::min(size.x > 0 ? 2 * half_x / size.x : std::numeric_limits<double>::infinity(),
                      size.y > 0 ? 2 * half_y / size.y : std::numeric_limits<double>::infinity());
    eye_ = centre - diagonal * forward_;
    return;
  }
  scale_ = std::max(middle_.x, middle_.y) / std::tan(0.5 * kFieldOfView);
  double away = 0;
  for (const Vec3& p : box.corners()) {
    const Vec3 d = p - centre;
    const double depth = dot(d, forward_);
    away = std::max({away, std::abs(dot(d, right_)) * scale_ / half_x - depth,
                     std::abs(dot(d, up_)) * scale_ / half_y - depth});
  }
  eye_ = centre - away * forward_;
  near_ = 1e-3 * diagonal;
}

Projected Camera::project(const Vec3& p) const {
  const Vec3 d = p - eye_;
  const double z = dot(d, forward_), x = dot(d, right_), y = dot(d, up_);
  if (projection_ == Projection::kOrthographic) return {{middle_.x + scale_ * x, middle_.y - scale_ * y}, z};
  return {{middle_.x + scale_ * x / z, middle_.y - scale_ * y / z}, -1 / z};
}

double Camera::distance_at_depth(double depth) const {
  return projection_ == Projection::kOrthographic ? depth : -1 / depth;
}

Vec3 Camera::towards(const Vec3& p) const {
  return projection_ == Projection::kOrthographic ? -forward_ : normalized(eye_ - p);
}

}  // namespace adamas::picture
