#pragma once

#include <vector>

#include "core/data/mesh_data.h"
#include "interfaces/mesh_reconstruction/mesh_values.h"
#include "interfaces/network/bodies.h"
#include "interfaces/reconstruction/flakes.h"

namespace adamas::interfaces {

/// Finds the flakes of interfaces of data on a mesh; moves have the numbers of cells.
std::vector<Flake> find_flakes(const MeshData& data, const MeshValues& values, const InterfaceMesh& mesh,
                               const Bodies& bodies);

}  // namespace adamas::interfaces
