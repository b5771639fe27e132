#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "core/base/error.h"
#include "core/geometry/vec3.h"
#include "isosurface/gradients/gradient_smoothing.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"

namespace adamas {

/// Takes one page, of which only `samples` are set: to the OctahedralCode of each point, its first byte
/// lowest.
using GradientPageSink = std::function<void(const PageId&, const Page<std::uint16_t>&)>;

/// How gradients are made into pages.
struct GradientPageOptions {
  /// None: they are the least squares' own.
  std::optional<GradientSmoothingOptions> smoothing = GradientSmoothingOptions{};
  /// Where directions lie meanwhile, two bytes for each sample, if a plane takes more memory than this.
  std::filesystem::path scratch = std::filesystem::temp_directory_path();
  std::size_t memory = std::size_t{384} << 20;  ///< bytes for smoothing, at least some rows of all planes
};

/// Gives every page of the volume's PageGrid once, with the directions of the gradients at its points, those
/// of coarser LODs too. On every LOD they are PlaneGradients of all samples (D 4.3.2), as smooth_gradients
/// makes them of the whole volume, to the bit; components count as 1e36 at most for it. Points beyond the
/// data have the gradient of the nearest sample. The order of pages depends on the volume's dimensions alone.
///
/// Planes are read in ascending order: once; for smoothing twice, or once more than there are strips of rows
/// that fit the memory. Beside that it takes 62 bytes and three samples for each sample of a plane of k.
/// Sample: uint8, uint16, int16 or float, as grid.type says. Throws Error for a grid that cannot be,
/// Cancelled when `progress` says so, and what `planes` and `sink` throw.
template <class Sample>
void gradient_pages(const VolumeGrid& grid, const PlaneSource& planes, const GradientPageSink& sink,
                    const GradientPageOptions& options, Progress& progress = SilentProgress::instance());

}  // namespace adamas
