#pragma once

#include "core/data/interface_mesh.h"
#include "core/geometry/vec3.h"
#include "interfaces/network/mended.h"

namespace adamas {

/// Turns triangles that are turned against their neighbours, where it is clear which. Triangles between the
/// same two materials that an edge tells the relative orientation of form sheets; where three materials or
/// more meet, the edge tells which way its triangles go, else three quarters of a sheet's triangles have to
/// agree. A sheet is turned, in whole or in part, where that makes the materials match round all its edges,
/// and else left as it is. Meshes whose materials match everywhere are not changed. Indices must be within
/// range; `domain` may be null.
Mended turn_wrong_triangles(InterfaceMesh& mesh, const Box3* domain);

}  // namespace adamas
