#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/vec3.h"
#include "isosurface/compression/height_grid.h"
#include "isosurface/compression/parity_cells.h"
#include "isosurface/volume/page.h"

namespace adamas {

/// What the error of the smallest diamonds depends on beside samples, where these lie `spacing` apart. Alike
/// on all LODs.
struct ErrorGeometry {
  explicit ErrorGeometry(const Vec3& spacing);

  /// See OctantStencils::slope_factors.
  std::array<float, 3> slope_factors;
  /// Squares of the diameters' ratios to the scale's greatest error: of the tetrahedra round edges along an
  /// axis, round faces across it, and of those in cubes.
  std::array<float, 3> edge_diameters, face_diameters;
  float centre_diameter;
};

/// The codes of the greatest errors of the diamonds' own tetrahedra, of all points of a page that it may own,
/// as far as the heights are known: where those in and on a diamond of the finest LOD are whole numbers of
/// 16 bits at most, that which preprocessing finds, bit for bit. Fills whole rows.
void known_errors(const HeightGrid& heights, const ErrorGeometry& geometry, const PageShape& shape,
                  AllCells<std::uint8_t>& codes);

}  // namespace adamas
