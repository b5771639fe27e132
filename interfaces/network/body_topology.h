#pragma once

#include <cstddef>

#include "adamas/geometry.h"
#include "adamas/meshes.h"  // BodyTopology
#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"
#include "core/distance/closest_point_tree.h"

namespace adamas::interfaces {

/// Finds the topology of `bodies` bodies, given a welded mesh whose `front` and `back` are bodies instead of
/// materials. Boundaries are seen from the inside of their body: triangles that bound the same wedge round an
/// edge are neighbours, so that bodies that touch themselves at a point or an edge are recognised. Faces of
/// the domain do not belong to a boundary. `tree` (may be null): a tree of the mesh's triangles.
IdVector<BodyId, BodyTopology> body_topology(InterfaceMesh mesh, std::size_t bodies, const Box3& domain,
                                             const ClosestPointTree* tree = nullptr);

}  // namespace adamas::interfaces
