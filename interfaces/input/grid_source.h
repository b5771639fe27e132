#pragma once

#include "adamas/progress.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/reconstruction/reconstruction.h"

namespace adamas::interfaces {

/// Makes a source with interfaces reconstructed from the data's volume fractions and fields from its sites.
/// `data` must outlive the source.
ResamplingSource make_grid_source(const MultiMaterialData& data, const ReconstructionOptions& options = {},
                                  Progress& progress = SilentProgress::instance());

/// Makes a source of given interfaces in a box. `data` (may be null; must outlive the source) gives the
/// fields; its fractions or labels, if any, determine which sites state a material's value. Throws Error if a
/// material of the mesh is not among the data's, or if no triangle lies between two materials.
ResamplingSource make_mesh_source(const InterfaceMesh& mesh, const Box3& box,
                                  const MultiMaterialData* data = nullptr,
                                  Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
