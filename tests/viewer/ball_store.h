#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <vector>

#include "adamas/volume_store.h"

namespace adamas::test {

/// Makes a store of 33^3 samples, which are 200 in the middle and fall by 10 for each unit of length down to
/// 0.
inline void make_ball_store(const std::filesystem::path& path, const VolumeGrid& like = {}) {
  VolumeGrid grid = like;
  grid.dimensions = {33, 33, 33};
  grid.type = SampleType::kUint8;
  std::vector<std::byte> samples;
  for (int k = 0; k < 33; ++k) {
    for (int j = 0; j < 33; ++j) {
      for (int i = 0; i < 33; ++i) {
        const double r =
            std::sqrt((i - 16.0) * (i - 16.0) + (j - 16.0) * (j - 16.0) + (k - 16.0) * (k - 16.0));
        samples.push_back(static_cast<std::byte>(std::lround(std::max(0.0, 200 - 10 * r))));
      }
    }
  }
  VolumeStore::build(path, grid, samples);
}

}  // namespace adamas::test
