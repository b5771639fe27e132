#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <vector>

#include "adamas/geometry.h"
#include "adamas/volume.h"
#include "core/io/volume_writer.h"

namespace adamas::test {

using namespace io;

/// Returns random samples of a volume, none of them NaN. The same grid leads to the same samples.
inline std::vector<std::byte> random_samples(const VolumeGrid& grid) {
  std::mt19937 random(5);
  std::vector<std::byte> bytes(grid.samples() * sample_bytes(grid.type));
  if (grid.type == SampleType::kFloat32) {
    std::uniform_real_distribution<float> value(-1e3f, 1e3f);
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(float)) {
      const float v = value(random);
      std::memcpy(bytes.data() + at, &v, sizeof(v));
    }
    return bytes;
  }
  for (std::byte& b : bytes) b = static_cast<std::byte>(random());
  return bytes;
}

inline std::span<const std::byte> plane_of(const std::vector<std::byte>& samples, const VolumeGrid& grid,
                                           std::uint64_t k) {
  return std::span(samples).subspan(k * grid.plane_bytes(), grid.plane_bytes());
}

inline void write_volume(const std::filesystem::path& path, const VolumeGrid& grid,
                         const std::vector<std::byte>& samples, const VolumeWriterOptions& options = {}) {
  VolumeWriter writer(path, grid, options);
  for (std::uint64_t k = 0; k < grid.dimensions[2]; ++k) writer.write_plane(plane_of(samples, grid, k));
  writer.finish();
}

inline std::vector<VolumeGrid> sample_grids() {
  std::vector<VolumeGrid> grids;
  for (const SampleType type :
       {SampleType::kUint8, SampleType::kUint16, SampleType::kInt16, SampleType::kFloat32}) {
    grids.push_back({{1, 1, 1}, type, {1, 1, 1}, {}});
    grids.push_back({{1, 6, 1}, type, {1, 0.5, 3}, {-1, 0, 1e-3}});
    grids.push_back({{1, 1, 4}, type, {2, 2, 2}, {0, 0, 1}});
    grids.push_back({{5, 3, 4}, type, {0.1, 1e-7, 3e5}, {-0.25, 1.0 / 3, 7}});
  }
  return grids;
}

}  // namespace adamas::test
