#pragma once

#include "adamas/grid_data.h"
#include "core/data/multi_material_data.h"

namespace adamas::inline core {

/// What a user of the library gives, checked, fractions mended: it borrows the arrays whose types are those
/// that are computed with. Throws Error as check(data) does.
MultiMaterialData to_multi_material_data(const GridData& data);

/// The way back: spans of the arrays of `data`.
GridData view(const MultiMaterialData& data);

}  // namespace adamas::inline core
