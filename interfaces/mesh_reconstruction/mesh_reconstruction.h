#pragma once

#include <vector>

#include "adamas/fractions.h"
#include "adamas/progress.h"
#include "adamas/reconstruct.h"  // CellAgreement
#include "core/data/interface_mesh.h"
#include "core/data/mesh_data.h"
#include "interfaces/network/bodies.h"

namespace adamas::interfaces {

/// What was found about the fractions of a mesh, and how well the values reproduce them.
struct MeshAgreement {
  FractionFindings findings;  ///< without the areas
  CellAgreement cells;
  std::vector<LostPlace> lost;  ///< groups of cells that hold a material of which nothing is shown there
  /// The volumes that the interfaces are to enclose: those of the input without dispersed parts.
  IdVector<MaterialId, double> volumes;
};

/// Interfaces of data on a mesh of polyhedra (docs/method.md, Any mesh).
struct MeshReconstruction {
  InterfaceMesh mesh;  ///< with the outside among its materials, if the mesh does not fill the box round it
  Bodies bodies;
  MeshAgreement agreement;
};

/// Reconstructs the interfaces of volume fractions or labels. `options`: of fractions.
MeshReconstruction reconstruct_mesh(const MeshData& data, const FractionOptions& options = {},
                                    Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
