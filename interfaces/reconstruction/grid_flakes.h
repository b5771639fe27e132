#pragma once

#include <array>
#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/flakes.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Finds the flakes of interfaces of data on a grid; moves have the numbers of sites.
std::vector<Flake> find_flakes(const MultiMaterialData& data, const SiteValues& values,
                               const InterfaceMesh& mesh, const std::vector<std::array<BodyId, 2>>& bodies,
                               const IdVector<BodyId, MaterialId>& body_materials);

}  // namespace adamas::interfaces
