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

namespace adamas::isosurface {

/// Where the directions of a plane of a step lie in a file of all of them.
struct CodePlaces {
  VolumeGrid grid;

  [[nodiscard]] std::uint64_t operator()(std::size_t step, std::uint64_t k, std::uint64_t row) const {
    const auto [nx, ny, nz] = grid.dimensions;
    return ((step * nz + k) * ny + row) * nx * sizeof(OctahedralCode);
  }
};

/// Writes the directions of the gradients of all steps of a series, smoothed in space and along time; see
/// series_gradient_pages. A first pass finds the scale of each step's gradients. Where not all rows of all
/// steps fit the memory, strips of them are smoothed with as many rows on either side as there are rounds in
/// space, which is all that they depend on.
template <class Sample>
void series_codes(const VolumeGrid& grid, std::span<const RowSource> steps,
                  const GradientPageOptions& options, ScratchFile& file, Progress& progress);

}  // namespace adamas::isosurface
