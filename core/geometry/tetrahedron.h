#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "adamas/geometry.h"
#include "core/geometry/ownership_problem.h"

namespace adamas::inline core {

/// A tetrahedron in space with the gradients of its barycentric weights.
struct Tetrahedron {
  explicit Tetrahedron(const std::array<Vec3, 4>& points) : corners(points) {
    const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], c = corners[3] - corners[0];
    const double determinant = dot(cross(a, b), c);
    slopes[1] = (1 / determinant) * cross(b, c);
    slopes[2] = (1 / determinant) * cross(c, a);
    slopes[3] = (1 / determinant) * cross(a, b);
    slopes[0] = -(slopes[1] + slopes[2] + slopes[3]);
    volume = determinant / 6;
    double farthest = 0, steepest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(corners[i][axis]));
      steepest = std::max(steepest, norm(slopes[i]));
    }
    slack = std::max(1e-12, 16 * std::numeric_limits<double>::epsilon() * farthest * steepest);
  }

  [[nodiscard]] Weights weights(const Vec3& p) const {
    const Vec3 d = p - corners[0];
    Weights w{0, dot(slopes[1], d), dot(slopes[2], d), dot(slopes[3], d)};
    w[0] = 1 - w[1] - w[2] - w[3];
    return w;
  }
  [[nodiscard]] Vec3 point(const Weights& w) const {
    return w[0] * corners[0] + w[1] * corners[1] + w[2] * corners[2] + w[3] * corners[3];
  }
  /// Gradient of the linear function with these values at the corners.
  [[nodiscard]] Vec3 gradient(const std::array<double, 4>& values) const {
    return values[0] * slopes[0] + values[1] * slopes[1] + values[2] * slopes[2] + values[3] * slopes[3];
  }
  [[nodiscard]] double diameter() const {
    double greatest = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j)
        greatest = std::max(greatest, squared_norm(corners[i] - corners[j]));
    }
    return std::sqrt(greatest);
  }

  std::array<Vec3, 4> corners;
  std::array<Vec3, 4> slopes;  ///< gradients of the weights
  double volume;               ///< positive for positive orientation
  double slack;  ///< weights this little below zero count as inside, so that what lies in a face is in both
                 ///< cells
};

/// The part of a triangle inside a tetrahedron, as barycentric weights: a convex polygon of up to seven
/// corners.
class ClippedTriangle {
 public:
  ClippedTriangle(const Tetrahedron& cell, const Vec3& a, const Vec3& b, const Vec3& c);
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] const Weights* begin() const { return corners_.data(); }
  [[nodiscard]] const Weights* end() const { return corners_.data() + size_; }

 private:
  friend bool meets(const Tetrahedron& cell, const Vec3& a, const Vec3& b, const Vec3& c);
  /// The part of the triangle whose corners have these weights.
  ClippedTriangle(double slack, const std::array<Weights, 3>& corners);

  std::array<Weights, 8> corners_;
  std::size_t size_ = 0;
};

/// Whether the triangle has a part inside the tetrahedron, as `!ClippedTriangle(...).empty()`, but quicker
/// where a corner is inside or a face separates them.
bool meets(const Tetrahedron& cell, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace adamas::inline core
