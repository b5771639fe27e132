#pragma once

#include <array>
#include <span>
#include <vector>

namespace adamas::interfaces {

/// A point of a plane, given by two coordinates, and a line between two points.
using PlanePoint = std::array<double, 2>;
using PlaneSegment = std::array<PlanePoint, 2>;

/// The part of the plane between two segments, from one line along the second axis to another; a triangle if
/// the segments meet.
struct Trapezoid {
  std::vector<PlanePoint> corners;  ///< three or four, counter-clockwise
  /// Returns the mean of the corners, which lies inside.
  [[nodiscard]] PlanePoint middle() const;
};

/// Returns the trapezoidal decomposition of the faces between segments (de Berg et al., Computational
/// Geometry, chapter 6): the bounded faces, each cut along the second axis above and below every end and
/// every crossing of segments. The segments may cross, touch, and lie on each other in any way; numbers must
/// be finite. The combinatorial structure is exact; the corners are rounded. Trapezoids without a width are
/// left out.
std::vector<Trapezoid> trapezoidal_decomposition(std::span<const PlaneSegment> segments);

}  // namespace adamas::interfaces
