#pragma once

#include "adamas/progress.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Moves values until predicted fractions are those of the data: blurred entries by what they miss, times the
/// length that it is worth, a few times.
void fit_blurred(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                 Progress& progress);

}  // namespace adamas::interfaces
