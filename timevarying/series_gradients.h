#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "core/base/unnamed_file.h"
#include "isosurface/gradients/gradient_pages.h"
#include "isosurface/gradients/octahedral_codes.h"
#include "isosurface/volume/page.h"

namespace adamas::timevarying {

/// Fills samples of plane k starting at a row, in whole rows.
using RowSource = std::function<void(std::uint64_t k, std::uint64_t row, std::span<std::byte> samples)>;

/// The place in a file of the gradient directions of a plane of a step; those of all steps follow each other.
struct CodePlaces {
  VolumeGrid grid;

  [[nodiscard]] std::uint64_t operator()(std::size_t step, std::uint64_t k, std::uint64_t row) const {
    const auto [nx, ny, nz] = grid.dimensions;
    return ((step * nz + k) * ny + row) * nx * sizeof(isosurface::OctahedralCode);
  }
};

/// Writes the directions of the gradients of all steps of a series, smoothed in space and along time; see
/// series_gradient_pages. A first pass finds the scale of each step's gradients. If not all rows of all steps
/// fit into memory, strips of them are smoothed, each with as many rows on either side as there are rounds in
/// space, which is as far as the result depends on them.
template <class Sample>
void series_codes(const VolumeGrid& grid, std::span<const RowSource> steps,
                  const isosurface::GradientPageOptions& options, ScratchFile& file, Progress& progress);

/// Takes one page of a step, as GradientPageSink does.
using SeriesGradientSink =
    std::function<void(std::size_t step, const isosurface::PageId&, const isosurface::Page<std::uint16_t>&)>;

/// Passes on the pages of gradients of the steps of a series, one step after another, as gradient_pages does
/// for a volume, but smoothed along time too (SeriesSmoother); the options have a smoothing that
/// is_along_time(). Rows of all steps are read together: once for the scale, and once more, with some
/// neighbours, for each strip of rows whose smoothing fits into memory. Meanwhile directions are on the
/// scratch disk, two bytes for each sample of each step.
template <class Sample>
void series_gradient_pages(const VolumeGrid& grid, std::span<const RowSource> steps,
                           const SeriesGradientSink& sink, const isosurface::GradientPageOptions& options,
                           Progress& progress = SilentProgress::instance());

}  // namespace adamas::timevarying
