#pragma once

#include <cstdint>

#include "adamas/progress.h"
#include "core/base/typed_id.h"
#include "interfaces/cutting/interface_target.h"
#include "interfaces/cutting/labelled_mesh.h"
#include "interfaces/network/body_topology.h"

namespace adamas::interfaces {

/// Moves vertices where bodies meet to the closest place where these bodies should meet, as far as the
/// quality of the cells round them allows.
void snap_vertices(LabelledMesh& mesh, const InterfaceTarget& target);

/// Gives pieces of bodies, connected through faces, to the bodies round them where a body has more pieces
/// than wanted: the smallest first, and none whose diagonal is greater than `size`.
void drop_specks(LabelledMesh& mesh, const IdVector<BodyId, BodyTopology>& wanted, double size);

/// Changes a mesh place by place, worst cells first, until no cell's least dihedral sine is below `wanted` or
/// no change helps any more: edges collapse, edges and faces are replaced, vertices move, each time only
/// where the least quality of what is changed grows. Bodies keep their topology, and interfaces stay within
/// the target's tolerance. Ends, and returns false, where passes leave many more cells below `wanted` than an
/// earlier one did: then dividing edges makes more bad cells than it mends.
bool improve_mesh(LabelledMesh& mesh, const InterfaceTarget& target, double wanted, Progress& progress);

/// Collapses edges at vertices from number `first` on, where no cell's least dihedral sine falls below
/// `least_quality`. Topology and tolerance are kept as by improve_mesh().
void coarsen_mesh(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t first,
                  double least_quality, Progress& progress);

}  // namespace adamas::interfaces
