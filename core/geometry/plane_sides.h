#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "core/geometry/plane.h"

namespace adamas::inline core {

/// Decides on which side of a plane the points of a box lie, so that every part of a subdivision of the box
/// that has points on both sides is cut, and the cuts fill the plane's part of the box once: points in the
/// plane count as above it, or as below if no point of the box lies below. Distances that are round-off count
/// as zero.
class PlaneSides {
 public:
  /// Throws Error, naming `source`, for numbers that are not finite, for a zero normal, and for a plane that
  /// does not cut the box.
  PlaneSides(const Plane& plane, const Box3& box, std::string_view source);

  [[nodiscard]] const Plane& plane() const { return plane_; }
  /// Unit normal.
  [[nodiscard]] const Vec3& normal() const { return normal_; }
  /// Signed distance from the plane, positive where the normal points to.
  [[nodiscard]] double distance(const Vec3& p) const { return snapped(dot(normal_, p - plane_.origin)); }
  /// Returns zero for a distance that is round-off, else the distance.
  [[nodiscard]] double snapped(double d) const { return d >= -tolerance_ && d <= tolerance_ ? 0 : d; }
  /// A displacement, far greater than round-off and far smaller than anything visible, to the side whose
  /// cells are cut where cells meet in the plane: points moved by it lie inside these cells.
  [[nodiscard]] Vec3 nudge() const { return (zero_above_ ? -4096 : 4096) * tolerance_ * normal_; }
  /// Whether a point at this distance is above.
  [[nodiscard]] bool above(double distance) const { return distance > 0 || (distance == 0 && zero_above_); }
  /// Returns the bounds along an axis of what the plane may cut of a box, were this endless along the axis;
  /// the lower bound is the greater one if it cuts nothing. More than round-off is allowed for.
  [[nodiscard]] std::array<double, 2> bounds_along(int axis, const Box3& box) const;
  /// The point where the plane meets the segment between two points on different sides of it. The order of
  /// the points may change its last bits.
  static Vec3 crossing(const Vec3& p, double dp, const Vec3& q, double dq) {
    if (dp == 0) return p;
    if (dq == 0) return q;
    return p + (dp / (dp - dq)) * (q - p);
  }

 private:
  Plane plane_;
  Vec3 normal_;
  double tolerance_ = 0;
  bool zero_above_ = true;
};

/// The plane's part of a box inside the box that `sides` was made for, as a convex polygon that runs
/// counter-clockwise seen from where the normal points to; replaces `corners`. The cuts of boxes that fill
/// the outer box fill its cut.
void cut_box(const PlaneSides& sides, const Box3& box, std::vector<Vec3>& corners);

}  // namespace adamas::inline core
