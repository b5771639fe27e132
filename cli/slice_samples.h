#pragma once

#include <functional>
#include <string>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "cli/command.h"
#include "cli/opened_store.h"
#include "cli/slice_input.h"
#include "cli/volume_reading.h"
#include "core/data/multi_material_data.h"
#include "core/geometry/plane.h"

namespace adamas::cli {

/// The one field and the one material of samples as data on a grid.
inline constexpr const char* kSampleField = "value";

/// Samples round a plane.
struct SampleSlab {
  MultiMaterialData data;  ///< in the frame of `grid`
  VolumeGrid grid;         ///< the whole volume
  std::optional<workflow::StepOfSeries> step{};
};

/// The samples that a plane's cross section depends on: those next to it along each axis, so of a plane at
/// right angles to an axis of the grid the layers on either side of it; of a coarser LOD where there would
/// be more than a picture shows, of which the console is told. Throws Error for a plane that does not cut the
/// data.
SampleSlab store_slab(const StoreInput& input, const Plane& plane, Session& session);
/// The same of a volume that is not stored.
SampleSlab volume_slab(io::VolumeReader reader, const Plane& plane, Session& session);

/// Where samples without materials come from.
enum class SampleOrigin { kNone, kStore, kVolume };

/// A store, what the options say is a volume, a file of one array of samples that is no material's, or an
/// image whose axes run aslant; `original`: the option of that name.
SampleOrigin sample_origin(const InputArguments& input, const VolumeInput& volume,
                           const std::string& original);

/// The samples round the plane, `step` naming that of a stored series, and `field` the array of an image that
/// has several. `check` looks at what was read. Throws Error (kUsage) at options that they do not know, and
/// Error where the plane does not cut them.
workflow::SliceInput load_samples(const InputArguments& input, VolumeInput volume, const std::string& step,
                                  SampleOrigin origin, std::string& field, const Plane& plane,
                                  const std::function<void(const workflow::SliceInput&)>& check,
                                  Session& session);

}  // namespace adamas::cli
