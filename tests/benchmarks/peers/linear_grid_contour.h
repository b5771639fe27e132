#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "adamas/geometry.h"

namespace adamas::bench {

/// Runs vtkContour3DLinearGrid on one thread, over tetrahedra in memory.
class LinearGridContour {
 public:
  using Tetrahedron = std::array<std::uint32_t, 4>;

  LinearGridContour(const std::vector<Vec3>& points, const std::vector<float>& values,
                    const std::vector<Tetrahedron>& tetrahedra);
  ~LinearGridContour();
  LinearGridContour(const LinearGridContour&) = delete;
  LinearGridContour& operator=(const LinearGridContour&) = delete;

  struct Size {
    std::uint64_t triangles = 0, points = 0;
  };
  /// Makes the contour anew. With `shared` triangles share their points.
  Size contour(double isovalue, bool shared, bool normals);

 private:
  struct Grid;
  std::unique_ptr<Grid> grid_;
};

}  // namespace adamas::bench
