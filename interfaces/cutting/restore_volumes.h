#pragma once

#include "interfaces/cutting/labelled_mesh.h"

namespace adamas {

/// Moves vertices where bodies meet so that each body has its volume, to 1e-11 of all: by the shortest moves,
/// in proportion to the inverse of the area round a vertex, that do it (Newton's method; the volumes'
/// derivatives are exact). Vertices whose cells would become worse than `wanted_quality` stay, and none moves
/// by more than `most`. What bodies have that are not there goes to the largest one. Returns whether volumes
/// are as wanted.
bool restore_volumes(LabelledMesh& mesh, const IdVector<BodyId, double>& volumes, double wanted_quality,
                     double most);

}  // namespace adamas
