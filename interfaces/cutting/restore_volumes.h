#pragma once

#include "adamas/progress.h"
#include "core/base/typed_id.h"
#include "interfaces/cutting/labelled_mesh.h"

namespace adamas::interfaces {

/// Moves vertices where bodies meet so that each body has its volume, to 1e-11 of all: by the shortest moves,
/// in proportion to the inverse of the area round a vertex, that do it (Newton's method; the volumes'
/// derivatives are exact). Vertices whose cells would become worse than `wanted_quality` stay, and none moves
/// by more than `most`. The largest body gets the volume of bodies that the mesh does not have. Returns
/// whether volumes are as wanted.
bool restore_volumes(LabelledMesh& mesh, const IdVector<BodyId, double>& volumes, double wanted_quality,
                     double most, Progress& progress);

}  // namespace adamas::interfaces
