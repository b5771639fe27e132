#pragma once

#include "adamas/grid_data.h"
#include "core/data/multi_material_data.h"

namespace adamas::inline core {

/// Converts data of a user of the library: checks them and normalises their fractions. Arrays that already
/// have the type used here are borrowed. Throws Error as check(data) does.
MultiMaterialData to_multi_material_data(const GridData& data);

/// Converts data for a user of the library: spans of the arrays of `data`.
GridData view(const MultiMaterialData& data);

}  // namespace adamas::inline core
