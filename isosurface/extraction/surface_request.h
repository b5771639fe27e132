#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "adamas/volume.h"
#include "core/geometry/plane.h"
#include "core/geometry/vec3.h"
#include "isosurface/contour/contour.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// Which surface of a store is wanted.
struct SurfaceRequest {
  double isovalue = 0;
  /// Diamonds with a greater isosurface error are split; units of length in the grid's frame.
  double error = 0;
  /// The surface has never more triangles than these, or those of the coarsest mesh: diamonds with the
  /// greatest errors are split first.
  std::optional<std::uint64_t> max_triangles;
  /// The surface is clipped to this box in the grid's frame, and the mesh stays coarse outside it.
  std::optional<Box3> region;
  /// What lies on the side of these that their normals point to is cut off too.
  std::vector<Plane> sides;
  /// See ContourOptions.
  double least_parameter = 1.0 / 1024;
  /// Whether points next to a vertex of the mesh are joined; and a number of triangles is reached by
  /// decimation of a finer surface, not by a coarser mesh alone.
  bool join = false;
  /// Whether a page that cannot be had is an Error, and not a coarser surface.
  bool strict = false;
  /// Whether other surfaces will be asked for after this one: then what was read of errors and ranges is
  /// kept.
  bool others_follow = false;

  /// How the surface is contoured, by the lattice point of the last sample and the spacing of samples.
  [[nodiscard]] ContourOptions contour_options(LatticePoint last_sample, const Vec3& spacing) const {
    // Points that may come to lie on samples are moved nowhere else.
    return {least_parameter, last_sample, least_parameter > 0 ? spacing : Vec3{}, join};
  }
};

/// Confines the surface to a box in space.
void set_region(SurfaceRequest& request, const VolumeGrid& grid, const Box3& region);

/// Throws Error, which begins with `name`, where no surface is possible: in data without cells, or in a
/// region outside of the data. `region`: the box that was given to set_region, for the message.
void check_surface_request(const std::string& name, const VolumeGrid& grid, const SurfaceRequest& request,
                           const std::optional<Box3>& region);

/// A surface and what it took to get it.
struct ExtractedSurface {
  Contour contour;
  std::uint64_t diamonds = 0;  ///< that are split; 0 where all are
  /// Of the mesh; where all diamonds are split, of the cells of samples that the surface crosses.
  std::uint64_t tetrahedra = 0;
  /// The greatest isosurface error among the diamonds that the surface crosses, and what decimation adds: an
  /// estimate.
  double max_error = 0;
  std::uint64_t bodies_left_out = 0;  ///< small ones for which there were too few triangles
  std::vector<PageId> lost;           ///< pages that could not be had: round them the surface is coarser
};

}  // namespace adamas::isosurface
