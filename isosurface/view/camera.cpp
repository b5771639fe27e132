#include "isosurface/view/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace adamas {

namespace {

double reach(const CentredBox& box, const Vec3& direction) {
  return std::abs(direction.x) * box.half.x + std::abs(direction.y) * box.half.y +
         std::abs(direction.z) * box.half.z;
}

void check(const Camera& camera) {
  bool finite = std::isfinite(camera.field_of_view + camera.height + camera.near);
  for (const Vec3& v : {camera.eye, camera.target, camera.up}) finite = finite && std::isfinite(v.x + v.y + v.z);
  if (!finite) fail("camera: expected finite numbers");
  if (camera.width_pixels < 1 || camera.height_pixels < 1)
    fail("camera: expected a picture of at least one pixel, found {} x {}", camera.width_pixels,
         camera.height_pixels);
  if (camera.height < 0 || !(camera.near > 0))
    fail("camera: expected a height of at least 0 and a near plane before the eye, found {} and {}", camera.height,
         camera.near);
  if (!(camera.field_of_view > 0 && camera.field_of_view < std::numbers::pi))
    fail("camera: expected an angle between 0 and pi, found {}", camera.field_of_view);
  if (!(norm(cross(camera.target - camera.eye, camera.up)) > 0))
    fail("camera: expected an eye that is not at the target, and an upward direction across the line of sight");
}

}  // namespace

View::View(const Camera& camera) : camera_(camera) {
  check(camera);
  const Vec3 forward = normalized(camera.target - camera.eye), right = normalized(cross(forward, camera.up)),
             up = cross(right, forward);
  const double aspect = static_cast<double>(camera.width_pixels) / camera.height_pixels;
  const auto side = [&](const Vec3& normal, const Vec3& point) { return Side{normal, dot(normal, point)}; };
  if (camera.height > 0) {
    const Vec3 half_up = 0.5 * camera.height * up, half_right = 0.5 * aspect * camera.height * right;
    sides_ = {side(right, camera.eye - half_right), side(-right, camera.eye + half_right),
              side(up, camera.eye - half_up), side(-up, camera.eye + half_up), {}};
    scale_ = camera.height_pixels / camera.height;
  } else {
    const double high = std::tan(camera.field_of_view / 2), wide = aspect * high;
    sides_ = {side(normalized(right + wide * forward), camera.eye), side(normalized(wide * forward - right), camera.eye),
              side(normalized(up + high * forward), camera.eye), side(normalized(high * forward - up), camera.eye), {}};
    // A way along the line of sight moves points of the picture too, most of all in its corners.
    scale_ = camera.height_pixels / (2 * high) * std::sqrt(1 + high * high + wide * wide);
  }
  sides_[4] = side(forward, camera.eye + camera.near * forward);
}

bool View::is_visible(const CentredBox& box) const {
  return std::ranges::all_of(sides_, [&](const Side& s) {
    return dot(s.normal, box.centre) - s.offset >= -reach(box, s.normal);
  });
}

double View::pixels(double length, const CentredBox& box) const {
  if (camera_.height > 0) return scale_ * length;
  const Side& near = sides_[4];
  const double behind_near = dot(near.normal, box.centre) - near.offset - reach(box, near.normal);
  return scale_ * length / (camera_.near + std::max(0.0, behind_near));
}

}  // namespace adamas
