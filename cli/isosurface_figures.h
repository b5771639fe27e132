#pragma once

#include <array>
#include <vector>

#include "cli/command.h"
#include "cli/figures.h"
#include "core/data/triangle_surface.h"
#include "isosurface/extraction/surface_request.h"
#include "isosurface/storage/stored_pages.h"

namespace adamas {

/// What is told of the surfaces of a run.
class IsosurfaceFigures {
 public:
  explicit IsosurfaceFigures(Session& session) : session_(session) {}

  /// `range`: least and greatest sample of the store.
  void add(const SurfaceRequest& request, const ExtractedSurface& surface,
           const std::array<double, 2>& range);
  /// `lost`: what the normals of the surface do without. Throws Error where the request is strict.
  void add_normals(const SurfaceRequest& request, const ExtractedSurface& surface,
                   const std::vector<PageId>& lost);
  void report(const TriangleSurface& surface, const PageCounts& counts);

 private:
  Session& session_;
  std::uint64_t tetrahedra_ = 0, diamonds_ = 0;
  double max_error_ = 0;
};

}  // namespace adamas
