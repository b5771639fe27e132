#pragma once

#include <cstdint>

#include "adamas/progress.h"
#include "core/base/typed_id.h"
#include "interfaces/cutting/interface_target.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas::interfaces {

/// Moves vertices where bodies meet to the closest point where these bodies should meet, as far as the
/// quality of the cells round them allows.
void snap_vertices(LabelledMesh& mesh, const InterfaceTarget& target);

/// Gives pieces of bodies, which are connected through faces, to the bodies round them if a body has more
/// pieces than wanted: the smallest first, and none whose diagonal exceeds `size`.
void drop_specks(LabelledMesh& mesh, const IdVector<BodyId, BodyTopology>& wanted, double size);

/// Changes a mesh locally, worst cells first, until no cell's least dihedral sine is below `wanted` or no
/// change helps any more. Edges are collapsed, edges and faces are replaced, and vertices are moved, each
/// only if the least quality of the changed cells grows. Bodies keep their topology, and interfaces stay
/// within the target's tolerance. This ends and returns false if a pass leaves many more cells below `wanted`
/// than an earlier one: then dividing edges makes more bad cells than it mends.
bool improve_mesh(LabelledMesh& mesh, const InterfaceTarget& target, double wanted, Progress& progress);

/// Collapses edges at vertices from number `first` on if no cell's least dihedral sine falls below
/// `least_quality`. Topology and tolerance are kept as in improve_mesh().
void coarsen_mesh(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t first,
                  double least_quality, Progress& progress);

}  // namespace adamas::interfaces
