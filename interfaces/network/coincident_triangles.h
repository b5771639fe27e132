#pragma once

#include "core/data/interface_mesh.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/mended.h"

namespace adamas {

/// What became of triangles on the same three points; each is counted where it was taken out.
struct CoincidentTriangles {
  Mended duplicates;      ///< the same materials on the same sides
  Mended thin_layers;     ///< a|b and b|c, a layer of b without thickness: a|c remains
  Mended cancelled;       ///< a|b and b|a, a layer without thickness in one material: nothing remains
  Mended contradictions;  ///< a|b and a|c, say; only where this is allowed
};

/// Leaves at most one triangle on any three points (of equal coordinates). A stack of layers without
/// thickness becomes what lies on either side of it. Throws TolerableFault, unless `tolerant`, where two
/// materials claim one side, and where triangles cancel each other and leave a hole, which is a sign of one
/// triangle too many; with `tolerant` the lowest of the claims remains. Indices must be within range;
/// `domain` may be null.
CoincidentTriangles merge_coincident_triangles(InterfaceMesh& mesh, const Box3* domain, bool tolerant);

}  // namespace adamas
