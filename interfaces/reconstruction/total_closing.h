#pragma once

#include "adamas/progress.h"
#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_cell.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Adds an offset to the values of each body, a connected part of a material's region, so that it has the
/// volume of the fractions in it and near it. This is for blurred fractions, whose sums are more exact than
/// those of single cells.
void close_bodies(const MultiMaterialData& data, SiteValues& values, const SiteCells& cells,
                  Progress& progress);

/// Adds an offset to the values of each material, so that the materials have the volumes `wanted` in the
/// whole domain. Large offsets, which would spoil cells, are distributed: a site's share grows with the part
/// of the mixed cells round it that are off already. The offsets are found by Newton's method; the volumes
/// are the gradient of a convex function of them.
void close_totals(const MultiMaterialData& data, const IdVector<MaterialId, double>& wanted,
                  SiteValues& values, const SiteCells& cells, Progress& progress);

}  // namespace adamas::interfaces
