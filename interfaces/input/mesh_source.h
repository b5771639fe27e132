#pragma once

#include "adamas/progress.h"
#include "core/data/mesh_data.h"
#include "interfaces/input/resampling_source.h"
#include "interfaces/mesh_reconstruction/mesh_reconstruction.h"

namespace adamas::interfaces {

/// Makes a source with interfaces that were reconstructed from the data's volume fractions or labels, and
/// fields from its cells and points. The box is that round the mesh; what the mesh does not fill of it is one
/// more material, kOutside, without fields. `data` must outlive the source.
ResamplingSource make_cells_source(const MeshData& data, MeshReconstruction&& reconstruction,
                                   Progress& progress = SilentProgress::instance());
/// The same with interfaces reconstructed here. `options`: of fractions.
ResamplingSource make_cells_source(const MeshData& data, const FractionOptions& options = {},
                                   Progress& progress = SilentProgress::instance());

}  // namespace adamas::interfaces
