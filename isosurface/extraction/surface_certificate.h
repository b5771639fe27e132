#pragma once

#include "adamas/progress.h"
#include "isosurface/extraction/surface_extractor.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas::isosurface {

/// Bounds of the distance between a surface and the surface of all samples, which is that of linear
/// interpolation in the finest tetrahedra. Lengths are those of the frame.
struct SurfaceCertificate {
  /// No point of either surface is farther from the other one than this. Infinite where one of them is empty.
  double certified = 0;
  double found = 0;  ///< some point is as far as this from the other surface
};

/// Converts a certificate in the frame to one in space. If the grid's axes are not orthogonal, lengths change
/// by a factor between two bounds.
SurfaceCertificate in_space(const VolumeGrid& grid, const SurfaceCertificate& in_frame);

/// A surface and its certificate.
struct CertifiedSurface {
  ExtractedSurface surface;
  SurfaceCertificate certificate;
};

/// The side of the blocks, in samples, in which the surface of all samples is made. Memory grows with the
/// surface in one block, not with the whole surface.
inline constexpr int kCertificateBlock = 96;

/// Measures a surface that was extracted for the request. Throws what extraction throws.
template <class Sample>
SurfaceCertificate certify_surface(SurfaceExtractor<Sample>& extractor, const SurfaceRequest& request,
                                   const Contour& surface, Progress& progress = SilentProgress::instance(),
                                   int block_samples = kCertificateBlock);

/// Extracts a surface whose certified distance is within the request's error. To this end the error by which
/// the mesh is refined is reduced until the distance is within it; if no joined surface is near enough, the
/// surface is not joined. If the request has no error, or a number of triangles, the surface is only
/// measured.
template <class Sample>
CertifiedSurface extract_certified(SurfaceExtractor<Sample>& extractor, const SurfaceRequest& request,
                                   Progress& progress = SilentProgress::instance());

}  // namespace adamas::isosurface
