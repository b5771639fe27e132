#pragma once

#include "adamas/progress.h"
#include "core/base/error.h"
#include "isosurface/extraction/split_pages.h"
#include "isosurface/extraction/surface_request.h"

namespace adamas {

/// The surface of a store with subtrees: the contour of the mesh in which the diamonds of `pages` are split
/// and then each tetrahedron that is crossed is bisected `bisections` times more. It is not clipped to the
/// request's region. Throws PageLost.
template <class Sample>
ExtractedSurface contour_of_subtrees(StoredDiamonds<Sample>& diamonds, SplitPages<Sample>& pages,
                                     const SurfaceRequest& request, int bisections, Progress& progress);

extern template ExtractedSurface contour_of_subtrees<std::uint8_t>(StoredDiamonds<std::uint8_t>&,
                                                                   SplitPages<std::uint8_t>&,
                                                                   const SurfaceRequest&, int, Progress&);
extern template ExtractedSurface contour_of_subtrees<std::uint16_t>(StoredDiamonds<std::uint16_t>&,
                                                                    SplitPages<std::uint16_t>&,
                                                                    const SurfaceRequest&, int, Progress&);
extern template ExtractedSurface contour_of_subtrees<std::int16_t>(StoredDiamonds<std::int16_t>&,
                                                                   SplitPages<std::int16_t>&,
                                                                   const SurfaceRequest&, int, Progress&);
extern template ExtractedSurface contour_of_subtrees<float>(StoredDiamonds<float>&, SplitPages<float>&,
                                                            const SurfaceRequest&, int, Progress&);

}  // namespace adamas
