#pragma once

#include "adamas/cut_mesh.h"
#include "core/base/typed_id.h"
#include "core/data/solver_mesh.h"

namespace adamas {

/// The implementation of a CutMesh.
struct CutMesh::Contents {
  SolverMesh mesh;
  IdVector<MaterialId, std::string> materials;
  CutMeshReport report;
};

}  // namespace adamas
