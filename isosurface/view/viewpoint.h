#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "adamas/geometry.h"

namespace adamas::isosurface {

class DepthPyramid;

/// A camera that looks at a surface, in the frame of the grid.
struct Viewpoint {
  Vec3 eye{0, 0, 1};
  Vec3 target{0, 0, 0};  ///< the point in the middle of the picture
  Vec3 up{0, 1, 0};      ///< not along the line of sight
  /// The angle between the lower and the upper edge of the picture, in radians; below pi.
  double field_of_view = 0.7853981633974483;
  /// The height of the picture in units of length, for parallel projection; 0 for perspective.
  double height = 0;
  double near = 1e-3;  ///< distance of the near plane along the line of sight
  std::int32_t width_pixels = 1024, height_pixels = 768;

  bool operator==(const Viewpoint&) const = default;
};

/// Unit vectors along the line of sight, and to the right and upwards in the picture.
struct ViewAxes {
  Vec3 forward, right, up;

  explicit ViewAxes(const Viewpoint& viewpoint)
      : forward(normalized(viewpoint.target - viewpoint.eye)),
        right(normalized(cross(forward, viewpoint.up))),
        up(cross(right, forward)) {}
};

/// The bounding box of something in the frame, by its centre and half of its sides.
struct CentredBox {
  Vec3 centre, half;
};

/// Determines which boxes a camera sees, and how many pixels lengths have there. Both answers are monotone: a
/// box that contains a visible box is visible, and lengths have at least as many pixels in it. Boxes that
/// depths hide are not visible.
class View {
 public:
  /// Makes the view. Throws Error where a number is not finite, the picture has no pixels, the eye is at the
  /// target, or the angle is not between 0 and pi.
  explicit View(const Viewpoint& viewpoint, std::shared_ptr<const DepthPyramid> depths = nullptr);

  [[nodiscard]] const Viewpoint& viewpoint() const { return viewpoint_; }
  /// Returns the depths; null where there are none.
  [[nodiscard]] const std::shared_ptr<const DepthPyramid>& depths() const { return depths_; }
  /// Returns whether a part of the box may be visible. False where all of it is outside the picture, or
  /// hidden; it may be true for boxes outside the picture near its corners.
  [[nodiscard]] bool is_visible(const CentredBox& box) const;
  /// Returns an upper bound, in pixels, of the distance in the picture between two points of the box that are
  /// `length` apart, if the one nearer to the eye is in the picture.
  [[nodiscard]] double pixels(double length, const CentredBox& box) const {
    return pixels_at(length, depth(box));
  }
  /// Returns the bound at a depth(); it is less at greater depths.
  [[nodiscard]] double pixels_at(double length, double depth) const {
    return viewpoint_.height > 0 ? scale_ * length : scale_ * length / depth;
  }
  /// Returns the distance from the eye, along the line of sight, of the nearest part of the box that is not
  /// before the near plane; at least the near plane's distance.
  [[nodiscard]] double depth(const CentredBox& box) const;

  struct Side {
    Vec3 normal;  ///< unit normal to the inside
    double offset;
  };
  /// Returns half of the extent of a box along a direction.
  static double reach(const CentredBox& box, const Vec3& direction);
  static constexpr std::size_t kNear = 4;
  /// Returns the sides of the visible region: left, right, lower, upper, near.
  [[nodiscard]] const std::array<Side, 5>& sides() const { return sides_; }

 private:
  Viewpoint viewpoint_;
  std::shared_ptr<const DepthPyramid> depths_;
  std::array<Side, 5> sides_;
  double scale_;  ///< pixels of a length, in perspective at the distance 1
};

}  // namespace adamas::isosurface
