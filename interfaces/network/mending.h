#pragma once

#include "core/data/interface_mesh.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/coincident_triangles.h"
#include "interfaces/network/gap_closing.h"
#include "interfaces/network/mended.h"

namespace adamas {

/// What was changed of an interface mesh.
struct InterfaceMending {
  ClosedGaps gaps;
  CoincidentTriangles coincident;
  Mended turned;  ///< triangles that were turned against their neighbours
};

struct InterfaceMendingOptions {
  /// Greatest width of gaps that are closed, in relation to the diagonal of the domain, or of the mesh's box.
  double gaps = 1e-6;
  /// Takes contradictions out instead of throwing TolerableFault.
  bool tolerant = false;
};

/// Closes small gaps, merges triangles on the same points and turns triangles that are turned the wrong way,
/// where it is clear what is right. A mesh that `check_interface_mesh` finds nothing odd about is not
/// changed. Throws Error for what `check_interface_arrays` refuses; `domain` may be null.
InterfaceMending mend_interface_mesh(InterfaceMesh& mesh, const Box3* domain,
                                     const InterfaceMendingOptions& options = {});

}  // namespace adamas
