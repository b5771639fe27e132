#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/geometry/plane.h"
#include "core/geometry/vec3.h"
#include "isosurface/contour/contour.h"
#include "isosurface/volume/page_grid.h"

namespace adamas {

/// Which surface of a store is wanted.
struct SurfaceRequest {
  double isovalue = 0;
  /// Diamonds with a greater isosurface error are split; units of length in the grid's frame.
  double error = 0;
  /// Never more triangles than these, but for those of the coarsest mesh: the greatest errors go first.
  std::optional<std::uint64_t> max_triangles;
  /// In the grid's frame; the surface is clipped to it, and coarse outside.
  std::optional<Box3> region;
  /// What lies on the side of these that their normals point to is cut off too.
  std::vector<Plane> sides;
  /// See ContourOptions.
  double least_parameter = 1.0 / 1024;
  /// Pages that cannot be had are an Error, not a coarser surface.
  bool strict = false;
  /// Other surfaces will be asked for after this one: what was read of errors and ranges is kept.
  bool others_follow = false;
};

/// A surface and what it took to get it.
struct ExtractedSurface {
  Contour contour;
  std::uint64_t diamonds = 0;    ///< that are split
  std::uint64_t tetrahedra = 0;  ///< of the mesh; with subtrees of the fine one
  /// The greatest isosurface error among the diamonds that the surface crosses.
  double max_error = 0;
  std::vector<PageId> lost;  ///< pages that could not be had: round them the surface is coarser
};

}  // namespace adamas
