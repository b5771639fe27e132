#pragma once

#include <vector>

#include "adamas/progress.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"
#include "interfaces/mesh_reconstruction/mesh_volumes.h"

namespace adamas::interfaces {

/// Moves the values of sharp materials, all together, until their volumes in active cells are those of the
/// fractions, as far as possible: by the Gauss-Newton method, each time by the shortest move that gives the
/// missing volumes (VolumeSystem). `extents`: of steps (Steps). `volumes`: of these values.
void fit_volumes(const std::vector<double>& extents, MeshValues& values, MeshVolumes& volumes,
                 Progress& progress);

}  // namespace adamas::interfaces
