#pragma once

#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

/// Finds fractions that no interface explains: of a material that takes little of each cell within some
/// distance, and some of most of them. Entries lose them to the other materials of their cells or, with
/// `keep`, are sharp, so that each cell gets a piece. Returns the volume of each material that has been
/// taken.
std::vector<double> take_dispersed(const MultiMaterialData& data, const ThinSheets& sheets, bool keep,
                                   SiteValues& values);

/// Whether all there is of a material, this volume, was found to be dispersed.
bool is_all_dispersed(const FractionFindings& findings, MaterialId material, double volume);

}  // namespace adamas::interfaces
