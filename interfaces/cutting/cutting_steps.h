#pragma once

#include "adamas/progress.h"
#include "core/base/error.h"
#include "interfaces/cutting/bisected_cells.h"
#include "interfaces/cutting/interface_target.h"
#include "interfaces/cutting/labelled_mesh.h"
#include "interfaces/network/body_topology.h"

namespace adamas::interfaces {

/// Divides each cell between the owners of its corners: one cut on each edge between two owners, one point on
/// each face of three, one in each cell of four. Neighbours divide what they share alike, and all volumes are
/// positive, wherever these points are inside of what they lie on.
LabelledMesh divide_cells(const BisectedCells& cells);

/// Gives pieces of bodies, connected through faces, to the bodies round them, where there are more pieces
/// than wanted: the smallest first, and none that is larger across than `size`.
void drop_specks(LabelledMesh& mesh, const IdVector<BodyId, BodyTopology>& wanted, double size);

/// Changes a mesh place by place, worst cells first, until no cell's least dihedral sine is below `wanted` or
/// nothing helps any more: edges collapse, edges and faces are replaced, vertices move, each time only where
/// the least quality of what is changed grows. Bodies keep their topology, and interfaces stay within the
/// target's tolerance. Ends, and returns false, where passes leave many more cells below `wanted` than an
/// earlier one did: dividing edges then makes more of them than it mends.
bool improve_mesh(LabelledMesh& mesh, const InterfaceTarget& target, double wanted, Progress& progress);

/// Collapses edges at vertices from number `first` on where no cell's least dihedral sine becomes less than
/// wanted: the same laws hold.
void coarsen_mesh(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t first,
                  double least_quality, Progress& progress);

/// Moves vertices where bodies meet so that each body has its volume, to 1e-11 of all: by the shortest moves,
/// in proportion to the inverse of the area round a vertex, that do it (Newton's method; the volumes'
/// derivatives are exact). Vertices whose cells would become worse than `wanted_quality` stay, and none moves
/// by more than `most`. What bodies have that are not there goes to the largest one. Returns whether volumes
/// are as wanted.
bool restore_volumes(LabelledMesh& mesh, const IdVector<BodyId, double>& volumes, double wanted_quality,
                     double most, Progress& progress);

}  // namespace adamas::interfaces
