#include "isosurface/view/viewpoint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "isosurface/view/depth_pyramid.h"

namespace adamas::isosurface {

namespace {

void check(const Viewpoint& viewpoint) {
  bool finite = std::isfinite(viewpoint.field_of_view + viewpoint.height + viewpoint.near);
  for (const Vec3& v : {viewpoint.eye, viewpoint.target, viewpoint.up})
    finite = finite && std::isfinite(v.x + v.y + v.z);
  if (!finite) fail("viewpoint: expected finite numbers");
  if (viewpoint.width_pixels < 1 || viewpoint.height_pixels < 1)
    fail("viewpoint: expected a picture of at least one pixel, found {} x {}", viewpoint.width_pixels,
         viewpoint.height_pixels);
  if (viewpoint.height < 0 || !(viewpoint.near > 0))
    fail("viewpoint: expected a height of at least 0 and a near plane before the eye, found {} and {}",
         viewpoint.height, viewpoint.near);
  if (!(viewpoint.field_of_view > 0 && viewpoint.field_of_view < std::numbers::pi))
    fail("viewpoint: expected an angle between 0 and pi, found {}", viewpoint.field_of_view);
  if (!(norm(cross(viewpoint.target - viewpoint.eye, viewpoint.up)) > 0))
    fail(
        "viewpoint: expected an eye that is not at the target, and an upward direction across the line of "
        "sight");
}

}  // namespace

double View::reach(const CentredBox& box, const Vec3& direction) {
  return std::abs(direction.x) * box.half.x + std::abs(direction.y) * box.half.y +
         std::abs(direction.z) * box.half.z;
}

View::View(const Viewpoint& viewpoint, std::shared_ptr<const DepthPyramid> depths)
    : viewpoint_(viewpoint), depths_(std::move(depths)) {
  check(viewpoint);
  const auto [forward, right, up] = ViewAxes(viewpoint);
  const double aspect = static_cast<double>(viewpoint.width_pixels) / viewpoint.height_pixels;
  const auto side = [&](const Vec3& normal, const Vec3& point) { return Side{normal, dot(normal, point)}; };
  if (viewpoint.height > 0) {
    const Vec3 half_up = 0.5 * viewpoint.height * up, half_right = 0.5 * aspect * viewpoint.height * right;
    sides_ = {side(right, viewpoint.eye - half_right),
              side(-right, viewpoint.eye + half_right),
              side(up, viewpoint.eye - half_up),
              side(-up, viewpoint.eye + half_up),
              {}};
    scale_ = viewpoint.height_pixels / viewpoint.height;
  } else {
    const double high = std::tan(viewpoint.field_of_view / 2), wide = aspect * high;
    sides_ = {side(normalized(right + wide * forward), viewpoint.eye),
              side(normalized(wide * forward - right), viewpoint.eye),
              side(normalized(up + high * forward), viewpoint.eye),
              side(normalized(high * forward - up), viewpoint.eye),
              {}};
    // Moves along the line of sight also move points of the picture, most in its corners.
    scale_ = viewpoint.height_pixels / (2 * high) * std::sqrt(1 + high * high + wide * wide);
  }
  sides_[4] = side(forward, viewpoint.eye + viewpoint.near * forward);
}

bool View::is_visible(const CentredBox& box) const {
  const bool is_in_picture = std::ranges::all_of(
      sides_, [&](const Side& s) { return dot(s.normal, box.centre) - s.offset >= -reach(box, s.normal); });
  return is_in_picture && (depths_ == nullptr || !depths_->hides(box));
}

double View::depth(const CentredBox& box) const {
  const Side& near = sides_[kNear];
  const double behind_near = dot(near.normal, box.centre) - near.offset - reach(box, near.normal);
  return viewpoint_.near + std::max(0.0, behind_near);
}

}  // namespace adamas::isosurface
