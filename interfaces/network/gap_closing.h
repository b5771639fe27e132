#pragma once

#include "core/data/interface_mesh.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/mended.h"

namespace adamas {

/// What was closed of the gaps of an interface mesh.
struct ClosedGaps {
  Mended points_on_faces;  ///< ends of sheets moved onto a face of the domain
  Mended welded_points;    ///< moved onto another point
  Mended split_edges;      ///< at points of other borders, which lay on them
};

/// Closes gaps between open borders that are at most `tolerance` wide, a length: borders that run along a
/// face of the domain are moved onto it; of points of borders that near each other one remains, nearest
/// first, unless a triangle would lose an edge; edges of borders are split at points of other borders. No
/// point moves farther than the gaps are wide, unless several gaps follow each other. What is not on an open
/// border does not change, nor does anything with a tolerance of 0. The result does not depend on the order
/// of triangles and points. Points must be finite and indices within range; `domain` may be null.
ClosedGaps close_gaps(InterfaceMesh& mesh, const Box3* domain, double tolerance);

}  // namespace adamas
