#pragma once

#include "core/base/progress.h"
#include "interfaces/cutting/interface_target.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas {

/// Changes a mesh place by place, worst cells first, until no cell's least dihedral sine is below `wanted` or
/// nothing helps any more: edges collapse, edges and faces are replaced, vertices move, each time only where
/// the least quality of what is changed grows. Bodies keep their topology, and interfaces stay within the
/// target's tolerance.
void improve_mesh(LabelledMesh& mesh, const InterfaceTarget& target, double wanted, Progress& progress);

/// Collapses edges at vertices from number `first` on where no cell's least dihedral sine becomes less than
/// wanted: the same laws hold.
void coarsen_mesh(LabelledMesh& mesh, const InterfaceTarget& target, std::uint32_t first,
                  double least_quality, Progress& progress);

}  // namespace adamas
