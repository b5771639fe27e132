#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/volume.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "isosurface/extraction/complete_surface.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas::cli {

/// What is told of the surfaces of a run.
class IsosurfaceFigures {
 public:
  /// Of a store with this grid.
  IsosurfaceFigures(Session& session, const VolumeGrid& grid) : session_(session), grid_(grid) {}

  /// `range`: least and greatest sample of the store.
  void add(const isosurface::SurfaceRequest& request, const isosurface::CompleteSurface& complete,
           const std::array<double, 2>& range);
  void report(const TriangleSurface& surface, const isosurface::PageCounts& counts);

 private:
  /// `lost`: what the normals of the surface do without.
  void add_normals(const isosurface::SurfaceRequest& request, const isosurface::ExtractedSurface& surface,
                   const std::vector<isosurface::PageId>& lost);
  void add_distance(const isosurface::SurfaceRequest& request,
                    const isosurface::SurfaceCertificate& distance);

  Session& session_;
  VolumeGrid grid_;  ///< its greatest stretch leads from errors in its frame to those in space
  std::uint64_t tetrahedra_ = 0, diamonds_ = 0, bodies_left_out_ = 0;
  double max_error_ = 0;
  std::optional<isosurface::SurfaceCertificate> distance_;  ///< the greatest of all surfaces
};

}  // namespace adamas::cli
