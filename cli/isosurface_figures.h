#pragma once

#include <array>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/figures.h"
#include "core/data/triangle_surface.h"
#include "core/data/volume.h"
#include "isosurface/extraction/surface_request.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas {

/// What is told of the surfaces of a run.
class IsosurfaceFigures {
 public:
  /// Of a store with this grid.
  IsosurfaceFigures(Session& session, const VolumeGrid& grid)
      : session_(session), stretch_(grid.greatest_stretch()), space_(grid.space) {}

  /// `range`: least and greatest sample of the store.
  void add(const SurfaceRequest& request, const ExtractedSurface& surface,
           const std::array<double, 2>& range);
  /// `lost`: what the normals of the surface do without. Throws Error where the request is strict.
  void add_normals(const SurfaceRequest& request, const ExtractedSurface& surface,
                   const std::vector<PageId>& lost);
  void report(const TriangleSurface& surface, const PageCounts& counts);

 private:
  Session& session_;
  double stretch_;     ///< from errors in the grid's frame to those in space
  std::string space_;  ///< of coordinates
  std::uint64_t tetrahedra_ = 0, diamonds_ = 0;
  double max_error_ = 0;
};

}  // namespace adamas
