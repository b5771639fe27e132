#pragma once

#include <vector>

#include "adamas/reconstruct.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/flakes.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Compares volumes with fractions, after the volumes `moves` are moved between materials. The result is
/// empty if no cell is mixed.
CellAgreement volume_agreement(const MultiMaterialData& data, const SiteValues& values,
                               const SiteCells& cells, std::vector<VolumeMove> moves);

}  // namespace adamas::interfaces
