#pragma once

#include <cstddef>

#include "adamas/geometry.h"
#include "core/data/interface_mesh.h"

namespace adamas::interfaces {

/// The number of places where something was mended, and the first place.
struct Mended {
  std::size_t count = 0;
  Vec3 place;
  void add(const Vec3& at) {
    if (count++ == 0) place = at;
  }
};

/// The changes that closed gaps of an interface mesh.
struct ClosedGaps {
  Mended points_on_faces;  ///< ends of sheets moved onto a face of the domain
  Mended welded_points;    ///< points moved onto another point
  Mended split_edges;      ///< edges split at points of other borders that lay on them
};

/// Closes gaps between open borders that are at most `tolerance` wide, a length: borders along a face of the
/// domain are moved onto it; points of borders that are close to each other become one, the closest first,
/// unless a triangle would lose an edge or a border would be folded at a point between them; edges of borders
/// are split at points of other borders. No point moves farther than the gaps are wide, unless several gaps
/// follow each other. Parts that are not on an open border do not change; with a tolerance of 0 nothing
/// changes. The result does not depend on the order of triangles and points. Points must be finite and
/// indices within range; `domain` may be null.
ClosedGaps close_gaps(InterfaceMesh& mesh, const Box3* domain, double tolerance);

/// The triangles that were removed because another one has the same three points.
struct CoincidentTriangles {
  Mended duplicates;      ///< triangles with the same materials on the same sides
  Mended thin_layers;     ///< a|b and b|c, a layer of b without thickness: a|c remains
  Mended cancelled;       ///< a|b and b|a, a layer without thickness in one material: nothing remains
  Mended contradictions;  ///< for example a|b and a|c; only if this is allowed
};

/// Leaves at most one triangle on any three points (of equal coordinates). A stack of layers without
/// thickness becomes one triangle between the materials on its two sides. Unless `tolerant`, this throws
/// TolerableFault if two materials claim one side, or if triangles cancel each other and leave a hole, which
/// is a sign of a superfluous triangle; with `tolerant` the lowest of the claims remains. Indices must be
/// within range; `domain` may be null.
CoincidentTriangles merge_coincident_triangles(InterfaceMesh& mesh, const Box3* domain, bool tolerant);

/// Turns triangles that are oriented against their neighbours, if it is clear which of them are wrong.
/// Triangles between the same two materials whose relative orientation follows from a common edge form
/// sheets. An edge of three materials or more determines the orientation of its triangles; without such an
/// edge three quarters of a sheet's triangles have to agree. A sheet is turned, in whole or in part, only if
/// the materials then match round all its edges. Meshes whose materials match everywhere are not changed.
/// Indices must be within range; `domain` may be null.
Mended turn_wrong_triangles(InterfaceMesh& mesh, const Box3* domain);

/// The changes that mended an interface mesh.
struct InterfaceMending {
  ClosedGaps gaps;
  CoincidentTriangles coincident;
  Mended turned;  ///< triangles that were turned against their neighbours
};

struct InterfaceMendingOptions {
  /// The greatest width of gaps that are closed, relative to the diagonal of the domain or of the mesh's box.
  double gaps = 1e-6;
  /// Whether contradictions are removed instead of throwing TolerableFault.
  bool tolerant = false;
};

/// Closes small gaps, merges triangles on the same points and turns triangles with the wrong orientation, if
/// it is clear what is right. A mesh in which `check_interface_mesh` finds no fault is not changed. Throws
/// Error as check_interface_arrays() does; `domain` may be null.
InterfaceMending mend_interface_mesh(InterfaceMesh& mesh, const Box3* domain,
                                     const InterfaceMendingOptions& options = {});

}  // namespace adamas::interfaces
