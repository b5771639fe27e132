#pragma once

#include <cstdint>
#include <functional>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "core/base/error.h"
#include "core/geometry/vec3.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"

namespace adamas {

/// Takes one page, of which only `samples` are set: to the OctahedralCode of each point, its first byte
/// lowest.
using GradientPageSink = std::function<void(const PageId&, const Page<std::uint16_t>&)>;

/// Gives every page of the volume's PageGrid once, with the directions of the gradients at its points, those
/// of coarser LODs too. On every LOD they are PlaneGradients of all samples (D 4.3.2). Points beyond the data
/// have the gradient of the nearest sample. The order of pages depends on the volume's dimensions alone.
///
/// Planes are read once, in ascending order. Memory: 50 bytes and three samples for each sample of a plane of
/// k. Sample: uint8, uint16, int16 or float, as grid.type says. Throws Error for a grid that cannot be,
/// Cancelled when `progress` says so, and what `planes` and `sink` throw.
template <class Sample>
void gradient_pages(const VolumeGrid& grid, const PlaneSource& planes, const GradientPageSink& sink,
                    Progress& progress = SilentProgress::instance());

}  // namespace adamas
