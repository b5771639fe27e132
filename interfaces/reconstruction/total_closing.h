#pragma once

#include "core/base/progress.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas {

/// Adds an offset to the values of each material, so that the materials have the volumes `wanted` in the
/// whole domain. Of offsets that would spoil cells a site's share is the greater, the more of the mixed cells
/// round it are off anyway. Newton's method, for the volumes are the gradient of a convex function of the
/// offsets.
void close_totals(const MultiMaterialData& data, const IdVector<MaterialId, double>& wanted,
                  SiteValues& values, const SiteCells& cells, Progress& progress);

}  // namespace adamas
