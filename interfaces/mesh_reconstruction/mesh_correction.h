#pragma once

#include "interfaces/mesh_reconstruction/mesh_reconstruction.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"

namespace adamas::interfaces {

/// Takes dispersed fractions out, and sets values so that cells hold their fractions: distances from planes
/// that cut off the fractions of sharp materials, or those that a blurred step has, corrected in rounds by
/// the volumes in the cells; then closes the total of each material, and extracts interfaces.
MeshReconstruction reconstruct_fractions(const MeshData& data, const FractionOptions& options,
                                         MeshValues& values, Progress& progress);

}  // namespace adamas::interfaces
