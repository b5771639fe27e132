#pragma once

#include "isosurface/contour/contour.h"
#include "isosurface/extraction/stored_diamonds.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas {

/// How the surface of a store is contoured.
template <class Sample>
ContourOptions contour_options(const StoredDiamonds<Sample>& diamonds, const SurfaceRequest& request) {
  // Points that may come to lie on samples are moved nowhere else.
  const bool moves = request.least_parameter > 0;
  return {request.least_parameter, diamonds.last_sample(), moves ? diamonds.spacing() : Vec3{}};
}

}  // namespace adamas
