#pragma once

#include "adamas/fractions.h"
#include "adamas/progress.h"
#include "adamas/reconstruct.h"  // CellAgreement
#include "core/data/mesh_data.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// What was found about the fractions of a mesh, and how well the values reproduce them.
struct MeshAgreement {
  FractionFindings findings;  ///< without the areas
  CellAgreement cells;
  std::vector<LostPlace> lost;  ///< groups of cells that hold a material of which nothing is shown there
  /// The volumes that the interfaces are to enclose: those of the input without dispersed parts.
  IdVector<MaterialId, double> volumes;
};

/// Takes dispersed fractions out, and sets values so that cells hold their fractions: distances from planes
/// that cut off the fractions of sharp materials, or those that a blurred step has, corrected in rounds by
/// the volumes in the cells; then closes the total of each material.
MeshAgreement correct_values(const MeshData& data, const FractionOptions& options, MeshValues& values,
                             Progress& progress);

}  // namespace adamas::interfaces
