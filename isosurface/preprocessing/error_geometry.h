#pragma once

#include <array>

#include "core/geometry/vec3.h"

namespace adamas::isosurface {

/// For each axis: the square of what turns a slope, per sample, into the ratio of the finest LOD's greatest
/// error to the distance over which a value changes by one. `spacing`: of the samples.
std::array<double, 3> slope_factors(const Vec3& spacing);

/// What the own errors depend on beside samples.
struct OwnErrorGeometry {
  explicit OwnErrorGeometry(const Vec3& spacing);

  std::array<double, 3> slope_factors;
  /// Squares of the diameters' ratios to the LOD's greatest error: of the tetrahedra round edges along an
  /// axis, of those round faces across it, and of those in cubes.
  std::array<float, 3> edge_diameters, face_diameters;
  float centre_diameter;
};

}  // namespace adamas::isosurface
