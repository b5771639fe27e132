#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/volume.h"
#include "cli/command.h"
#include "cli/figures.h"
#include "cli/surface_picture.h"
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

/// What a picture of isosurfaces shows.
struct IsosurfacePicture {
  std::string title;              ///< but for the isovalue
  std::vector<double> isovalues;  ///< several have colours and a legend
  std::vector<std::size_t> ends;  ///< `isovalues[n]` is that of the triangles before `ends[n]`, from the one
                                  ///< before it on
  Box3 domain;
};

/// Draws isosurfaces to a picture file, smooth where they have normals; says so where there is no triangle.
void write_isosurface_picture(const std::filesystem::path& path, const TriangleSurface& surface,
                              const IsosurfacePicture& what, const PictureOptions& camera);

}  // namespace adamas::cli
