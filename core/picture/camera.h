#pragma once

#include "adamas/geometry.h"
#include "adamas/picture.h"
#include "core/picture/vec2.h"

namespace adamas::picture {

/// The position of a point on the image: pixels from the upper left corner, and a depth that grows with the
/// distance and is an affine function of the pixel position on any plane in space.
struct Projected {
  Vec2 at;
  double depth = 0;
};

/// A camera that shows all of a box as large as the image allows.
class Camera {
 public:
  /// `direction` is the viewing direction; z is up on the image (y, if the camera looks along z). Throws
  /// Error for an empty or infinite box or a direction that is zero or not finite.
  Camera(Projection projection, const Box3& box, const Vec3& direction, double width, double height,
         double margin = 0.05);

  /// The signed distance of a point from the camera's plane, positive in front.
  [[nodiscard]] double distance_of(const Vec3& p) const { return dot(p - eye_, forward_); }
  /// Points nearer than this are clipped (perspective); minus infinity for orthographic cameras.
  [[nodiscard]] double near() const { return near_; }
  /// Projects a point, for which distance_of(p) >= near() must hold.
  [[nodiscard]] Projected project(const Vec3& p) const;
  /// The distance for a depth: the inverse of Projected::depth.
  [[nodiscard]] double distance_at_depth(double depth) const;
  /// The unit vector from a point towards the camera.
  [[nodiscard]] Vec3 towards(const Vec3& p) const;

  [[nodiscard]] const Vec3& right() const { return right_; }
  [[nodiscard]] const Vec3& up() const { return up_; }
  [[nodiscard]] const Vec3& forward() const { return forward_; }

 private:
  Projection projection_;
  Vec3 eye_, right_, up_, forward_;
  double scale_ = 1;  // pixels per unit of length, or of slope
  double near_;
  Vec2 middle_;
};

}  // namespace adamas::picture
