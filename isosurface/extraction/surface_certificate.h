#pragma once

#include "adamas/progress.h"
#include "isosurface/extraction/surface_extractor.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas::isosurface {

/// How far a surface and the surface of all samples are from each other, which is that of linear
/// interpolation in the finest tetrahedra; lengths are of the frame.
struct SurfaceCertificate {
  double certified =
      0;             ///< no point of either is farther from the other; infinite where one of them is empty
  double found = 0;  ///< some point is as far
};

/// The same in space: where axes run aslant, lengths change by a factor between two bounds.
SurfaceCertificate in_space(const VolumeGrid& grid, const SurfaceCertificate& in_frame);

/// A surface that was measured.
struct CertifiedSurface {
  ExtractedSurface surface;
  SurfaceCertificate certificate;
};

/// Side of the blocks in which the surface of all samples is made, in samples: memory grows with the surface
/// in one of them, not with all of it.
inline constexpr int kCertificateBlock = 96;

/// Measures a surface that was extracted for the request. Throws what extraction throws.
template <class Sample>
SurfaceCertificate certify_surface(SurfaceExtractor<Sample>& extractor, const SurfaceRequest& request,
                                   const Contour& surface, Progress& progress = SilentProgress::instance(),
                                   int block_samples = kCertificateBlock);

/// A surface whose certified distance is within the request's error: the error that meshes are refined by is
/// made smaller until it is; where no joined surface is near enough, a plain one is given. Where no error is
/// wanted, or only so many triangles, the surface is measured and left as it is.
template <class Sample>
CertifiedSurface extract_certified(SurfaceExtractor<Sample>& extractor, const SurfaceRequest& request,
                                   Progress& progress = SilentProgress::instance());

}  // namespace adamas::isosurface
