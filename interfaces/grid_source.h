#pragma once

#include "core/base/progress.h"
#include "core/data/interface_mesh.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/reconstruction.h"
#include "interfaces/source.h"

namespace adamas {

/// Interfaces reconstructed from the data's volume fractions, fields from its sites. `data` must outlive the
/// source.
ResamplingSource make_grid_source(const MultiMaterialData& data,
                                  Progress& progress = SilentProgress::instance());

/// Given interfaces in a box; the fields, where there are any, from the sites of `data` (its fractions are
/// not used). `data` may be null; it must outlive the source, and its materials must be named as the mesh's.
ResamplingSource make_mesh_source(const InterfaceMesh& mesh, const Box3& box,
                                  const MultiMaterialData* data = nullptr);

}  // namespace adamas
