#pragma once

#include <vector>

#include "datasets/scene_function.h"

namespace adamas::datasets {

/// The volume of the part of a box where all functions, which must be linear, are at least zero; exact to
/// round-off. The faces of the part are kept as polygons, which are cut by one plane after the other.
double clipped_volume(const Box3& box, const std::vector<SceneFunction>& half_spaces);

}  // namespace adamas::datasets
