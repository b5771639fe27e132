#pragma once

#include "adamas/progress.h"
#include "core/base/typed_id.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas::interfaces {

/// Moves vertices where bodies meet so that each body has its volume, up to 1e-11 of the whole. The moves are
/// the shortest ones, with weights inverse to the area round a vertex (Newton's method; the volumes'
/// derivatives are exact). Vertices whose cells would become worse than `wanted_quality` stay, and none moves
/// by more than `most`. The largest body gets the volume of bodies that the mesh does not have. Returns
/// whether all bodies have their volumes.
bool restore_volumes(LabelledMesh& mesh, const IdVector<BodyId, double>& volumes, double wanted_quality,
                     double most, Progress& progress);

}  // namespace adamas::interfaces
