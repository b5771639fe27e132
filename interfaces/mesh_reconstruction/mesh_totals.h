#pragma once

#include "adamas/progress.h"
#include "core/data/mesh_data.h"
#include "interfaces/mesh_reconstruction/mesh_volumes.h"

namespace adamas::interfaces {

/// Moves all values of each material by one offset until it has its volume; `volumes`: of these values.
/// Returns the volumes that materials own then.
IdVector<MaterialId, double> close_totals(const MeshData& data, const IdVector<MaterialId, double>& wanted,
                                          MeshValues& values, MeshVolumes& volumes, Progress& progress);

}  // namespace adamas::interfaces
