#pragma once

#include <vector>

#include "datasets/scene_function.h"

namespace adamas::datasets {

/// Volume of the part of a box where all functions, which must be linear, are at least zero. Exact to
/// round-off; keeps the part's faces as polygons and cuts them by one plane after the other.
double clipped_volume(const Box3& box, const std::vector<SceneFunction>& half_spaces);

}  // namespace adamas::datasets
