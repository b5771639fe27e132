#pragma once

#include "adamas/progress.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Changes values until the volume of each material in each mixed cell is that of its fraction, as far as
/// possible (see CellAgreement), and then closes the totals. Full cells that other materials would enter
/// are corrected too. `cells` must belong to the data's grid.
void correct_volumes(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                     Progress& progress);

}  // namespace adamas::interfaces
