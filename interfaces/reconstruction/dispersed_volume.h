#pragma once

#include <vector>

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/site_values.h"
#include "interfaces/reconstruction/thin_sheets.h"

namespace adamas::interfaces {

/// Finds dispersed fractions, which no interface explains: those of a material that has a small part of most
/// cells within some distance and a large part of none. They are given to the other materials of their cells
/// or, with `keep`, their entries become sharp, so that each cell gets a piece. Returns the volume of each
/// material that was given away.
std::vector<double> take_dispersed(const MultiMaterialData& data, const ThinSheets& sheets, bool keep,
                                   SiteValues& values);

/// Returns whether the whole of a material was found to be dispersed. `volume`: the volume of the material.
bool is_all_dispersed(const FractionFindings& findings, MaterialId material, double volume);

}  // namespace adamas::interfaces
