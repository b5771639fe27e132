#pragma once

#include <cstdint>
#include <optional>

#include "adamas/export.h"
#include "adamas/geometry.h"
#include "adamas/meshes.h"
#include "adamas/progress.h"
#include "adamas/volume.h"
#include "adamas/volume_store.h"

namespace adamas ADAMAS_API {

/// Cuts the samples of a volume by a plane: each sample shows its value, and values are linear between
/// samples. They are the field "value" of one material. Where the section would have more samples than a
/// large picture shows, it is of every 2^N-th one along each axis, which a note says; cells are numbered
/// among the samples next to the plane. Throws Error where the samples are not as many as the grid's, or only
/// one along an axis, and where the plane misses them or is none; Cancelled where the progress says so.
Slice slice(const Volume& volume, const Plane& plane, Progress& progress = SilentProgress::instance());

/// Cuts a step of a store in this way; without a step the first one, which a note says where there are
/// several. Only the pages near the plane are read. Throws Error (kUsage) too where there is no such step,
/// and Error where a page is damaged.
Slice slice(VolumeStore& store, const Plane& plane, const std::optional<std::uint64_t>& step = {},
            Progress& progress = SilentProgress::instance());

}  // namespace adamas
