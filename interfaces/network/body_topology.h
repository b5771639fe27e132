#pragma once

#include <cstddef>

#include "adamas/geometry.h"
#include "adamas/meshes.h"  // BodyTopology
#include "core/base/typed_id.h"
#include "core/data/interface_mesh.h"
#include "interfaces/network/interface_network.h"

namespace adamas::interfaces {

/// A body in place of a material, for meshes between bodies.
inline MaterialId as_material(BodyId body) { return MaterialId(body.value); }

/// Finds the topology of `bodies` bodies, given a welded mesh whose `front` and `back` are bodies instead of
/// materials. Boundaries are seen from the inside of their body: triangles that bound the same wedge round an
/// edge are neighbours, so that bodies that touch themselves at a point or an edge are recognised. Faces of
/// the domain do not belong to a boundary.
IdVector<BodyId, BodyTopology> body_topology(InterfaceMesh mesh, std::size_t bodies, const Box3& domain);

/// Finds the same of the bodies of a network in its domain. It takes no more memory for it than the triangles
/// round `points_at_once` points need, for each thread, if the network is closed and oriented: each body is
/// one piece then.
IdVector<BodyId, BodyTopology> body_topology(const InterfaceNetwork& network, const Box3& domain,
                                             std::size_t points_at_once = std::size_t{1} << 17);

}  // namespace adamas::interfaces
