#include "isosurface/preprocessing/error_geometry.h"

#include <algorithm>

#include "core/lattice/lattice_point.h"

namespace adamas::isosurface {
namespace {

/// Spacing over the greatest of the three, so that no square is too large for a number.
Vec3 relative(const Vec3& spacing) { return (1 / std::max({spacing.x, spacing.y, spacing.z})) * spacing; }

/// Of a lattice vector, where samples lie `spacing` apart.
double squared_length(LatticePoint d, const Vec3& spacing) {
  const double x = d.i * spacing.x, y = d.j * spacing.y, z = d.k * spacing.z;
  return x * x + y * y + z * z;
}

/// The square of the LOD's greatest error: the diameter of the tetrahedra in cubes.
double squared_greatest(const Vec3& spacing) { return squared_length({2, 2, 2}, spacing); }

float squared_ratio(const std::array<LatticePoint, 4>& corners, const Vec3& spacing) {
  double squared = 0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < a; ++b)
      squared = std::max(squared, squared_length(corners[a] - corners[b], spacing));
  }
  return static_cast<float>(squared / squared_greatest(spacing));
}

}  // namespace

std::array<double, 3> slope_factors(const Vec3& spacing) {
  const Vec3 step = relative(spacing);
  std::array<double, 3> factors{};
  // No greater ones: their products have to fit in a float. Errors come out too large rather than too small.
  for (int axis = 0; axis < 3; ++axis)
    factors[static_cast<std::size_t>(axis)] =
        std::min(squared_greatest(step) / (step[axis] * step[axis]), 0x1p80);
  return factors;
}

OwnErrorGeometry::OwnErrorGeometry(const Vec3& spacing)
    : slope_factors(adamas::isosurface::slope_factors(spacing)) {
  const Vec3 step = relative(spacing);
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    LatticePoint a{}, b{}, c{};
    a[axis] = 1, b[(axis + 1) % 3] = 1, c[(axis + 2) % 3] = 1;
    edge_diameters[at] = squared_ratio({-a, a, b, b + c}, step);
    face_diameters[at] = squared_ratio({-b - c, b - c, b + c, a}, step);
  }
  centre_diameter = squared_ratio({{{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {1, 1, 1}}}, step);
}

}  // namespace adamas::isosurface
