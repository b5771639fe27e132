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

/// Options of the extraction of a surface.
struct SurfaceRequest {
  double isovalue = 0;
  /// Diamonds with a greater isosurface error are split; units of length in the grid's frame.
  double error = 0;
  /// The surface never has more triangles than this, or than the surface of the coarsest mesh. Diamonds with
  /// the greatest errors are split first.
  std::optional<std::uint64_t> max_triangles;
  /// The part of the surface to which the normal of one of these planes points is cut off too.
  std::optional<Box3> region;
  /// The part of the surface on the side to which the normal of one of these planes points is cut off too.
  std::vector<Plane> sides;
  /// ContourOptions::least_parameter.
  double least_parameter = 1.0 / 1024;
  /// Join points next to a vertex of the mesh. With max_triangles, the surface is then a finer one that was
  /// decimated, not only that of a coarser mesh.
  bool join = false;
  /// Throw Error for a lost page. Otherwise the surface is coarser there.
  bool strict = false;
  /// Keep errors and ranges in memory for further surfaces.
  bool others_follow = false;

  /// Returns the options of the contour, given the lattice point of the last sample and the spacing of
  /// samples.
  [[nodiscard]] ContourOptions contour_options(LatticePoint last_sample, const Vec3& spacing) const {
    // Points that may lie on samples are not moved for another reason.
    return {least_parameter, last_sample, least_parameter > 0 ? spacing : Vec3{}, join};
  }
};

/// Clips the surface to a box in space.
void set_region(SurfaceRequest& request, const VolumeGrid& grid, const Box3& region);

/// Throws Error, which begins with `name`, where no surface is possible: the data have no cells, or the
/// region lies outside the data. `region`: the box that was given to set_region(), for the message.
void check_surface_request(const std::string& name, const VolumeGrid& grid, const SurfaceRequest& request,
                           const std::optional<Box3>& region);

/// A surface and the figures of its extraction.
struct ExtractedSurface {
  Contour contour;
  std::uint64_t diamonds = 0;  ///< number of split diamonds; 0 where all are split
  /// Number of tetrahedra of the mesh; if all diamonds are split, that of the cells of samples that the
  /// surface crosses.
  std::uint64_t tetrahedra = 0;
  /// An estimate of the error: the greatest isosurface error of the diamonds that the surface crosses, plus
  /// the error of decimation.
  double max_error = 0;
  std::uint64_t bodies_left_out = 0;  ///< small bodies for which there were too few triangles
  std::vector<PageId> lost;           ///< the lost pages, round which the surface is coarser
};

}  // namespace adamas::isosurface
