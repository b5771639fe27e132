#pragma once

#include "core/data/unstructured_mesh.h"
#include "interfaces/mesh/resampled_mesh.h"

namespace adamas {

/// Each cell divided along the interfaces into tetrahedra of one material, with `material`, `body`, `cell`
/// and the fields of that material at points; a point on an interface comes once for each of its sides. Cells
/// with more than two bodies are also cut where nothing changes, so that neighbours may divide the face they
/// share differently.
UnstructuredMesh cut_mesh(const ResampledMesh& mesh);

}  // namespace adamas
