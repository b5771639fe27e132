#pragma once

#include "cli/store_input.h"
#include "core/data/multi_material_data.h"
#include "core/geometry/plane.h"

namespace adamas {

/// The one field and the one material of samples as data on a grid.
inline constexpr const char* kSampleField = "value";

/// The samples of a store that a plane's cross section depends on: of a plane at right angles to an axis the
/// layers on either side of it, otherwise all; of a coarser level where there would be more than a picture
/// shows, of which the console is told. Throws Error for a plane that does not cut the data.
MultiMaterialData store_slab(const StoreInput& input, const Plane& plane, Session& session);

}  // namespace adamas
