#pragma once

#include "interfaces/cutting/labelled_mesh.h"
#include "interfaces/network/body_topology.h"

namespace adamas {

/// Gives pieces of bodies, connected through faces, to the bodies round them, where there are more pieces
/// than wanted: the smallest first, and none that is larger across than `size`.
void drop_specks(LabelledMesh& mesh, const IdVector<BodyId, BodyTopology>& wanted, double size);

}  // namespace adamas
