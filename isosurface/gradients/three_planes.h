#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "adamas/progress.h"
#include "adamas/volume.h"
#include "isosurface/volume/samples.h"

namespace adamas::isosurface {

/// Calls fn({below, plane, above}) with the samples of each plane of a volume and of its neighbours, in
/// ascending order; null beyond the first and the last. Every plane is read once.
template <class Sample, class Fn>
void for_each_three_planes(const VolumeGrid& grid, const PlaneSource& planes, const char* stage, Fn&& fn,
                           Progress& progress) {
  const std::uint64_t nz = grid.dimensions[2];
  // Plane k lies at k % 3.
  std::array<std::vector<Sample>, 3> samples;
  for (auto& plane : samples) plane.resize(grid.plane_samples());
  const auto read = [&](std::uint64_t k) { planes(k, std::as_writable_bytes(std::span(samples[k % 3]))); };
  read(0);
  for (std::uint64_t k = 0; k < nz; ++k) {
    progress.step(stage, static_cast<double>(k) / static_cast<double>(nz));
    if (k + 1 < nz) read(k + 1);
    const Sample* below = k > 0 ? samples[(k + 2) % 3].data() : nullptr;
    const Sample* above = k + 1 < nz ? samples[(k + 1) % 3].data() : nullptr;
    fn(std::array<const Sample*, 3>{below, samples[k % 3].data(), above});
  }
}

}  // namespace adamas::isosurface
