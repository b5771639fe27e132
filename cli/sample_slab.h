#pragma once

#include "cli/store_input.h"
#include "cli/volume_input.h"
#include "core/data/multi_material_data.h"
#include "core/data/volume.h"
#include "core/geometry/plane.h"

namespace adamas {

/// The one field and the one material of samples as data on a grid.
inline constexpr const char* kSampleField = "value";

/// Samples round a plane.
struct SampleSlab {
  MultiMaterialData data;  ///< in the frame of `grid`
  VolumeGrid grid;         ///< the whole volume
};

/// The samples that a plane's cross section depends on: those next to it along each axis, so of a plane at
/// right angles to an axis of the grid the layers on either side of it; of a coarser level where there would
/// be more than a picture shows, of which the console is told. Throws Error for a plane that does not cut the
/// data.
SampleSlab store_slab(const StoreInput& input, const Plane& plane, Session& session);
/// The same of a volume that is not stored.
SampleSlab volume_slab(VolumeReader reader, const Plane& plane, Session& session);

}  // namespace adamas
