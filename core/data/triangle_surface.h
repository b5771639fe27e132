#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/vec3.h"

namespace adamas {

/// A surface of triangles on shared points, without materials: what isosurfaces are exported as.
struct TriangleSurface {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of points, counterclockwise from outside
  std::vector<Vec3> normals;                            ///< none, or of each point: a unit vector or zero
  std::vector<float> values;                            ///< none, or of each point
  std::string value_name = "value";                     ///< what the values are, in files that have names

  /// Throws Error with `name` where there are normals or values but not one for each point, a number is not
  /// finite, or a triangle has a point that is not there.
  void check(const std::string& name) const;
};

}  // namespace adamas
