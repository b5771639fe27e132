#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "adamas/geometry.h"
#include "core/lattice/lattice_point.h"
#include "isosurface/contour/contour.h"

namespace adamas::isosurface {

/// The mean of points that are joined, which accumulates their triangles.
class JoinedPoint {
 public:
  void add(const Vec3& point, const EdgePoint& edge) {
    step_ = count_ == 0 ? edge.step() : std::min(step_, edge.step());
    ++count_;
    sum_ += point;
    vertex_ = edge.nearer_end();
  }

  /// Adds a triangle that has at least one of the points: its area vector, which is half the cross product of
  /// two of its sides, the length of that, and the dot product of that with a corner.
  void add_triangle(const Vec3& area_vector, double area, double moment) {
    area_ += area;
    area_vector_ += area_vector;
    moment_ += moment;
  }
  /// Adds the triangles of another mean of the same point.
  void add_triangles_of(const JoinedPoint& other) {
    add_triangle(other.area_vector_, other.area_, other.moment_);
  }

  /// Returns the position. The mean of points on a curved surface lies on its concave side. So the mean is
  /// moved along the mean normal of the triangles, until the cones from it over the triangles have a total
  /// volume of zero.
  [[nodiscard]] Vec3 position() const {
    const Vec3 mean = 1.0 / count_ * sum_;
    const double length = norm(area_vector_);
    // If the triangles face in all directions, there is no mean normal.
    constexpr double kLeastPart = 0.7;
    if (!(length > kLeastPart * area_)) return mean;
    const double way = (moment_ - dot(area_vector_, mean)) / length;
    // The move is limited to a part of the extent of the triangles.
    const double farthest = 0.1 * std::sqrt(area_);
    return mean + std::clamp(way, -farthest, farthest) / length * area_vector_;
  }
  [[nodiscard]] VertexPoint vertex_point() const { return {vertex_, step_}; }

 private:
  std::int32_t count_ = 0, step_ = 0;
  Vec3 sum_, area_vector_;
  double area_ = 0, moment_ = 0;
  LatticePoint vertex_{};
};

}  // namespace adamas::isosurface
