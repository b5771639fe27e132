#pragma once

#include <optional>

#include "adamas/progress.h"
#include "isosurface/extraction/surface_certificate.h"
#include "isosurface/extraction/surface_extractor.h"
#include "isosurface/extraction/surface_normals.h"

namespace adamas::isosurface {

/// An extracted surface with its certificate and its normals, if they are wanted.
struct CompleteSurface {
  ExtractedSurface surface;
  std::optional<SurfaceCertificate> distance;  ///< the certificate, in space
  SurfaceNormals normals;
};

/// Extracts a surface as the request says, by extract_certified() if it is to be certified. Throws what these
/// throw, and Error where normals depend on a damaged page and the request is strict.
template <class Sample>
CompleteSurface extract_complete(SurfaceExtractor<Sample>& extractor, const SurfaceRequest& request,
                                 bool certify, bool normals,
                                 Progress& progress = SilentProgress::instance()) {
  CompleteSurface result;
  if (certify) {
    CertifiedSurface certified = extract_certified(extractor, request, progress);
    result.surface = std::move(certified.surface);
    result.distance = in_space(extractor.pages().file().header().grid, certified.certificate);
  } else {
    result.surface = extractor.extract(request, progress);
  }
  if (!normals) return result;
  result.normals = surface_normals<Sample>(extractor.pages(), result.surface.contour, progress);
  if (request.strict && !result.normals.lost.empty())
    fail_as(ErrorKind::kDamaged, "{} is damaged, on which normals depend",
            page_name(result.normals.lost.front()));
  return result;
}

}  // namespace adamas::isosurface
