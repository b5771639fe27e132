#pragma once

#include <vector>

#include "adamas/progress.h"
#include "core/base/error.h"
#include "core/geometry/vec3.h"
#include "isosurface/contour/contour.h"
#include "isosurface/extraction/lattice_samples.h"
#include "isosurface/volume/samples.h"

namespace adamas {

/// The normals of a surface's points.
struct SurfaceNormals {
  std::vector<Vec3> normals;
  /// Damaged pages that some of them do without, in the order in which they were met.
  std::vector<PageId> lost;
};

/// A unit vector for each point of a surface, to values below the isovalue, as the triangles' normals point;
/// zero where nothing changes. They are gradients at the ends of the mesh's edges, interpolated along the
/// edge: the directions that the store keeps, or else by least squares from the 26 neighbours as far away as
/// the mesh is fine there. Samples that cannot be had do not count; stored directions that cannot be had are
/// worked out from samples.
template <class Sample>
SurfaceNormals surface_normals(StoredPages<OrderedWord<Sample>>& pages, const Contour& contour,
                               Progress& progress = SilentProgress::instance());

}  // namespace adamas
