#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "adamas/volume.h"

namespace adamas::io {

/// Computes the values (VolumeGrid::value) of samples of the grid's type.
void find_values(const VolumeGrid& grid, std::span<const std::byte> samples, std::vector<float>& values);

}  // namespace adamas::io
