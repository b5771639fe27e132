#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::test {

using TriangleIndices = std::array<std::uint32_t, 3>;

/// Returns the distance of a point from a triangle: from its plane where the point lies above it, else from
/// its sides.
double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Triangles in the boxes of a uniform grid, for distances from them.
class SurfaceGrid {
 public:
  SurfaceGrid(const std::vector<Vec3>& points, const std::vector<TriangleIndices>& triangles);
  /// Returns the distance from the nearest triangle; infinite where there are none.
  [[nodiscard]] double distance(const Vec3& p) const;

 private:
  using Index = std::array<int, 3>;
  [[nodiscard]] Index index_of(const Vec3& p) const;
  [[nodiscard]] std::size_t slot(const Index& i) const;
  /// Returns a lower bound, close but for round-off, of the distance of a point from one of the grid's boxes.
  [[nodiscard]] double distance_to_box(const Vec3& p, const Index& i) const;

  std::vector<std::array<Vec3, 3>> corners_;
  Box3 box_;
  Index count_{1, 1, 1};
  double side_ = 1;
  std::vector<std::vector<std::uint32_t>> boxes_;
};

/// Returns points of a surface that lie in the box: all corners, and `count` random points, uniform by area.
std::vector<Vec3> sample_surface(const std::vector<Vec3>& points,
                                 const std::vector<TriangleIndices>& triangles, const Box3& box,
                                 std::size_t count, std::uint64_t seed);

/// Returns the greatest distance of sampled points of either surface from the other: a lower bound of the
/// two-sided Hausdorff distance.
double sampled_distance(const std::vector<Vec3>& points_a, const std::vector<TriangleIndices>& triangles_a,
                        const std::vector<Vec3>& points_b, const std::vector<TriangleIndices>& triangles_b,
                        const Box3& box, std::size_t count, std::uint64_t seed);

}  // namespace adamas::test
