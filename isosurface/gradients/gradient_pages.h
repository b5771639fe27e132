#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "core/base/error.h"
#include "core/geometry/vec3.h"
#include "isosurface/gradients/gradient_smoothing.h"
#include "isosurface/volume/page.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// Takes one page, of which only `samples` are set: to the OctahedralCode of each point, its first byte
/// lowest.
using GradientPageSink = std::function<void(const PageId&, const Page<std::uint16_t>&)>;

/// The same of a step of a series.
using SeriesGradientSink = std::function<void(std::size_t step, const PageId&, const Page<std::uint16_t>&)>;
/// Fills samples of plane k from a row on, whole rows of them.
using RowSource = std::function<void(std::uint64_t k, std::uint64_t row, std::span<std::byte> samples)>;

/// How gradients are made into pages.
struct GradientPageOptions {
  /// None: they are the least squares' own.
  std::optional<GradientSmoothingOptions> smoothing = GradientSmoothingOptions{};
  /// Where directions lie meanwhile, two bytes for each sample, if a plane takes more memory than this;
  /// empty: the system's folder for temporary files.
  std::filesystem::path scratch{};
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

/// The same of the steps of a series, one after another, smoothed along time too (SeriesSmoother); the
/// options have a smoothing that is_along_time(). Rows are read for all steps side by side: all once for the
/// scale, and once more, with some beside, for each strip of rows whose smoothing fits the memory. Directions
/// lie on the scratch disk meanwhile, two bytes for each sample of each step.
template <class Sample>
void series_gradient_pages(const VolumeGrid& grid, std::span<const RowSource> steps,
                           const SeriesGradientSink& sink, const GradientPageOptions& options,
                           Progress& progress = SilentProgress::instance());

}  // namespace adamas::isosurface
