#pragma once

#include "core/data/multi_material_data.h"
#include "interfaces/reconstruction/material_lattice.h"
#include "interfaces/reconstruction/site_values.h"

namespace adamas::interfaces {

/// Returns the area of the interfaces of the data's fractions themselves: where the greatest of the linearly
/// interpolated fractions changes, in the tetrahedra of the lattice. `values` of the data tell which
/// materials are near each site.
double interface_area_of_fractions(const MultiMaterialData& data, const SiteValues& values,
                                   const MaterialLattice& lattice);

}  // namespace adamas::interfaces
