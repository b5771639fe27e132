#pragma once

#include "adamas/fractions.h"
#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "core/data/mesh_data.h"
#include "interfaces/mesh_reconstruction/mesh_correction.h"

namespace adamas::interfaces {

/// Interfaces of data on a mesh of polyhedra (docs/method.md, Any mesh).
struct MeshReconstruction {
  InterfaceMesh mesh;  ///< with the outside among its materials, if the mesh does not fill the box round it
  MeshAgreement agreement;
};

/// Reconstructs the interfaces of volume fractions or labels. `options`: of fractions.
MeshReconstruction reconstruct_mesh(const MeshData& data, const FractionOptions& options = {},
                                    Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
