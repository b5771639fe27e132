#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/geometry/plane.h"
#include "isosurface/contour/contour.h"
#include "isosurface/volume/page_grid.h"

namespace adamas::isosurface {

/// Describes the wanted surface of a store.
struct SurfaceRequest {
  double isovalue = 0;
  /// Diamonds with a greater isosurface error are split; units of length in the grid's frame.
  double error = 0;
  /// The surface never has more triangles than this, or than the surface of the coarsest mesh. Diamonds with
  /// the greatest errors are split first.
  std::optional<std::uint64_t> max_triangles;
  /// The surface is clipped to this box in the grid's frame, and the mesh stays coarse outside it.
  std::optional<Box3> region;
  /// The part of the surface on the side to which the normal of one of these planes points is cut off too.
  std::vector<Plane> sides;
  /// See ContourOptions.
  double least_parameter = 1.0 / 1024;
  /// Whether points next to a vertex of the mesh are joined. With max_triangles, the surface is then a finer
  /// one that was decimated, not only that of a coarser mesh.
  bool join = false;
  /// Whether a lost page is an Error. Otherwise the surface is coarser there.
  bool strict = false;
  /// Whether other surfaces will be asked for after this one, so that the errors and ranges that were read
  /// are kept in memory.
  bool others_follow = false;

  /// The options of the contour, by the lattice point of the last sample and the spacing of samples.
  [[nodiscard]] ContourOptions contour_options(LatticePoint last_sample, const Vec3& spacing) const {
    // Points that may come to lie on samples are moved nowhere else.
    return {least_parameter, last_sample, least_parameter > 0 ? spacing : Vec3{}, join};
  }
};

/// Clips the surface to a box in space.
void set_region(SurfaceRequest& request, const VolumeGrid& grid, const Box3& region);

/// Throws Error, which begins with `name`, where no surface is possible: where the data have no cells, or the
/// region lies outside the data. `region`: the box that was given to set_region, for the message.
void check_surface_request(const std::string& name, const VolumeGrid& grid, const SurfaceRequest& request,
                           const std::optional<Box3>& region);

/// A surface and the figures of its extraction.
struct ExtractedSurface {
  Contour contour;
  std::uint64_t diamonds = 0;  ///< how many diamonds are split; 0 where all are
  /// How many tetrahedra the mesh has; where all diamonds are split, those in the cells of samples that the
  /// surface crosses.
  std::uint64_t tetrahedra = 0;
  /// An estimate of the error: the greatest isosurface error of the diamonds that the surface crosses, plus
  /// the error of decimation.
  double max_error = 0;
  std::uint64_t bodies_left_out = 0;  ///< small bodies for which there were too few triangles
  std::vector<PageId> lost;           ///< the lost pages; round them the surface is coarser
};

}  // namespace adamas::isosurface
